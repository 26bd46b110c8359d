// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/base/log.h"
#include "coordinator/render/render_request.h"

namespace treefarm {

/// Renders the passes before the one that `name` is of, since they teach the model that guides it (but for those that
/// the request's checkpoint knows). Of a sample, "pass,x,y,sample", prints the path vertex by vertex on standard
/// output; of a tile, "pass,x0,y0,x1,y1,chunk", traces what a worker would get as one unit, in this process and thread,
/// so that a debugger can look at a crash, and prints how much that was. `tell`: what goes wrong meanwhile. Throws
/// InputError if there is no such sample or tile.
void debug_sample(const RenderRequest& request, const std::string& name, const TellMessage& tell);

}  // namespace treefarm
