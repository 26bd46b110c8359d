// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace treefarm {

/// Writes a file that holds a secret, whole or not at all, readable by its owner alone. Throws RunError.
void write_private_file(const std::filesystem::path& path, const std::string& text);

/// Text of a file that this user alone can read, `most_bytes` of it. Throws InputError where it cannot be read, with
/// `cure`; and where another user could have read or made it.
std::string read_private_file(const std::filesystem::path& path, std::size_t most_bytes, const std::string& cure);

}  // namespace treefarm
