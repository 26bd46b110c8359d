// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "common/base/error.h"

namespace treefarm {

/// The size of a file that a scene names. InputError at `asked_from`, where its name stands, if it is missing, is no
/// file, has more than 8 GiB or only points to a file in Git LFS.
std::uintmax_t input_file_size(const std::filesystem::path& path, const Location& asked_from);

/// All bytes of a file that a scene names. Throws as input_file_size().
std::string read_input_file(const std::filesystem::path& path, const Location& asked_from);

}  // namespace treefarm
