// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace treefarm {

/// The channels of a file that are its picture: R, G, B, or Y, or else the only ones of that name in any layer
/// ("diffuse.R"); after them the layer's A, if there is one. Throws InputError that names the file: there are none, or
/// several layers have them.
std::vector<std::string> choose_color_channels(const std::filesystem::path& path,
                                               const std::vector<std::string>& names);

}  // namespace treefarm
