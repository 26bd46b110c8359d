// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include "coordinator/passes/pass_loop.h"
#include "coordinator/render/render_request.h"

namespace treefarm {

/// Renders passes of a request, beginning with `state`, by a worker in this process, without a run directory. `tell`
/// receives error messages. Throws RunError.
RenderResult render_without_files(const RenderRequest& request, const PassChooser& passes, RenderState state,
                                  const PassHooks& hooks, const TellMessage& tell);

/// Passes of a request; empty if they depend on time or error.
std::vector<PassPlan> known_passes(const RenderRequest& request);

/// Model that guides a pass, and the pass with the matching kernel. Renders the passes before, which teach the model,
/// except for those in the request's checkpoint. Throws RunError.
std::pair<AnyModel, PassPlan> model_and_pass(const RenderRequest& request, const std::vector<PassPlan>& plans,
                                             std::uint32_t index, const TellMessage& tell);

}  // namespace treefarm
