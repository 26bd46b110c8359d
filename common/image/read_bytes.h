// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace treefarm {

/// A whole file of at most 2 GiB. Throws InputError that names the file: missing, not a regular file (`cure` says what
/// to give), too large, unreadable.
std::vector<std::uint8_t> read_bytes(const std::filesystem::path& path, const std::string& cure);

}  // namespace treefarm
