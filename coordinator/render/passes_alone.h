// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include "coordinator/passes/pass_loop.h"
#include "coordinator/render/render_request.h"

namespace treefarm {

/// Renders passes of a request from a state on by a worker in this process, without a run directory. `tell`: what goes
/// wrong. Throws RunError.
RenderResult render_without_files(const RenderRequest& request, const PassChooser& passes, RenderState state,
                                  const PassHooks& hooks, const TellMessage& tell);

/// The passes of a request; nothing where they depend on clock or error.
std::vector<PassPlan> known_passes(const RenderRequest& request);

/// The model that guides a pass, and the pass with the kernel that goes with it. Renders the passes before, which teach
/// the model, but for those that the request's checkpoint knows. Throws RunError.
std::pair<AnyModel, PassPlan> model_and_pass(const RenderRequest& request, const std::vector<PassPlan>& plans,
                                             std::uint32_t index, const TellMessage& tell);

}  // namespace treefarm
