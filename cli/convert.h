// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <iosfwd>
#include <string>

namespace treefarm {

/// Options of treefarm convert IMAGE.exr OUT.png
struct ConvertOptions {
    std::string image, output;
    std::string layer;         ///< empty: the beauty image
    double exposure = 0;       ///< in stops
    std::string tonemap = "";  ///< empty: srgb
};

/// Writes one layer of an EXR image as a PNG for viewing, or as an EXR or PFM file. Throws InputError for unreadable
/// files and invalid options, RunError if the file cannot be written.
void run_convert(const ConvertOptions& options, std::ostream& out);

}  // namespace treefarm
