// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <iosfwd>
#include <string>

#include "cli/launch_environment.h"

namespace CLI {
class App;
}

namespace treefarm {

/// treefarm convert IMAGE.exr OUT.png
struct ConvertOptions {
    std::string image, output;
    std::string layer;         ///< empty: the image itself
    double exposure = 0;       ///< stops
    std::string tonemap = "";  ///< empty: srgb
};

/// Writes one layer of an EXR image as a PNG to look at, or as an EXR or PFM of its own. Throws InputError for what
/// cannot be read or asked for, RunError if the file cannot be written.
void run_convert(const ConvertOptions& options, std::ostream& out);

/// Registers the subcommand.
void add_convert_command(CLI::App& app, const LaunchEnvironment& launch, int& exit_code);

}  // namespace treefarm
