// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "coordinator/run/render_run.h"

namespace treefarm {

/// Name of one camera path of a render.
struct SampleName {
    std::uint32_t pass = 0;
    int x = 0, y = 0;          ///< pixel
    std::uint32_t sample = 0;  ///< within the pass
};

/// Sample name from "pass,x,y,sample"; throws InputError.
SampleName parse_sample_name(const std::string& text);

/// Renders the passes before the sample's, which teach the tree that guides it (except those in the request's
/// checkpoint), traces the sample and prints its path vertex by vertex on standard output. Returns the exit code;
/// throws InputError if there is no such sample.
int debug_sample(const RenderRequest& request, const SampleName& name);

/// Whether the text is a tile's name, of the form "pass,x0,y0,x1,y1,chunk".
bool names_tile(const std::string& text);

/// Renders one work unit as debug_sample() does, in this process and thread, and prints its statistics, so that a crash
/// can be examined with a debugger. Throws InputError if there is no such tile.
int debug_tile(const RenderRequest& request, const std::string& text);

}  // namespace treefarm
