// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace treefarm {

/// Writes a file with a secret atomically, readable by its owner alone. Throws FileError.
void write_private_file(const std::filesystem::path& path, const std::string& text);

/// Text of a file that only this user can read, at most `most_bytes`. Throws InputError if it cannot be read, with
/// `cure`, or if another user could have read or made it.
std::string read_private_file(const std::filesystem::path& path, std::size_t most_bytes, const std::string& cure);

}  // namespace treefarm
