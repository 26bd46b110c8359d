// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "common/base/error.h"

namespace treefarm {

/// Size in bytes of a file that a scene names. Throws InputError at `asked_from`, the location of its name, if it is
/// missing, is no regular file, has more than 8 GiB, or is a Git LFS pointer.
std::uintmax_t input_file_size(const std::filesystem::path& path, const Location& asked_from);

/// All bytes of a file that a scene names. Throws like input_file_size().
std::string read_input_file(const std::filesystem::path& path, const Location& asked_from);

}  // namespace treefarm
