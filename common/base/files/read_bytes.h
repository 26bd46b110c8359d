// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace treefarm {

/// A limit of files that people give: stb counts in int.
inline constexpr std::uintmax_t kMostBytes = 0x7fffffff;

/// A whole file of at most `most` bytes. Throws InputError that names the file: missing, not a regular file (`cure`
/// says what to give), too large, unreadable.
std::vector<std::uint8_t> read_bytes(const std::filesystem::path& path, const std::string& cure,
                                     std::uintmax_t most = kMostBytes);

}  // namespace treefarm
