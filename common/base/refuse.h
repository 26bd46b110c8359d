// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "common/base/error.h"

namespace treefarm {

/// Throws InputError about a user's file or folder as a whole.
[[noreturn]] inline void refuse(const std::filesystem::path& path, const std::string& what, const std::string& cure) {
    throw InputError(Location{path.string(), 0, 0}, what, cure);
}

}  // namespace treefarm
