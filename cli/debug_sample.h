// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "coordinator/run/render_run.h"

namespace treefarm {

/// Names one camera path of a render.
struct SampleName {
    std::uint32_t pass = 0;
    int x = 0, y = 0;          ///< pixel
    std::uint32_t sample = 0;  ///< within the pass
};

/// A sample's name from "pass,x,y,sample"; throws InputError.
SampleName parse_sample_name(const std::string& text);

/// Renders the passes before the sample's, since they teach the tree that guides it (but for those that the request's
/// checkpoint knows), traces the sample and prints its path vertex by vertex on standard output. Returns the exit code;
/// throws InputError if there is no such sample.
int debug_sample(const RenderRequest& request, const SampleName& name);

/// Whether the text names a tile: has the form of "pass,x0,y0,x1,y1,chunk".
bool names_tile(const std::string& text);

/// Renders as debug_sample() does what a worker would get as one unit, in this process and thread, and prints how much
/// that was: whatever it crashes can be looked at by a debugger. Throws InputError if there is no such tile.
int debug_tile(const RenderRequest& request, const std::string& text);

}  // namespace treefarm
