// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coordinator/passes/pass_loop.h"
#include "coordinator/render/render_request.h"

namespace treefarm {

/// Traces again the passes up to the last one whose film the request's checkpoint has lost, and gives these films back
/// to the checkpoint's state. The other films, the guide and what was learned are kept. `hooks`: interrupted and
/// on_progress. Returns false if interrupted. Throws RunError if a film does not have its former bits.
bool retrace_films(Farm& farm, const RenderRequest& request, RenderState& state, PassHooks hooks);

}  // namespace treefarm
