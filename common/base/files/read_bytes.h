// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace treefarm {

/// Limit of files given by users: stb counts in int.
inline constexpr std::uintmax_t kMostBytes = 0x7fffffff;

/// Content of a file of at most `most` bytes. Throws InputError with the file's name if it is missing, not a regular
/// file (`cure`: what to give instead), too large, or unreadable.
std::vector<std::uint8_t> read_bytes(const std::filesystem::path& path, const std::string& cure,
                                     std::uintmax_t most = kMostBytes);

/// Content of a file that may be missing, unreadable or no regular file: empty, or as far as it can be read.
std::string read_text(const std::filesystem::path& path);

}  // namespace treefarm
