// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace treefarm {

/// Colour channels of a file: R, G, B, or Y, or else the only ones of these names in any layer ("diffuse.R"); then the
/// layer's A, if it has one. Throws InputError with the file's name if there are none, or if several layers have them.
std::vector<std::string> choose_color_channels(const std::filesystem::path& path,
                                               const std::vector<std::string>& names);

}  // namespace treefarm
