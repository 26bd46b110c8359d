// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/base/log.h"
#include "coordinator/render/render_request.h"

namespace treefarm {

/// Traces the sample or tile `name`, after rendering the passes before its own, which teach the model that guides it
/// (except for those in the request's checkpoint). For a sample, "pass,x,y,sample", prints the path vertex by vertex on
/// standard output; for a tile, "pass,x0,y0,x1,y1,chunk", traces the work unit in this process and thread, for a
/// debugger, and prints its statistics. `tell`: receives error messages. Throws InputError if there is no such sample
/// or tile.
void debug_sample(const RenderRequest& request, const std::string& name, const TellMessage& tell);

}  // namespace treefarm
