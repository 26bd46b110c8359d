// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "common/base/descriptor.h"

namespace treefarm {

/// Descriptor of a regular file; `flags` and `mode` as of open(2). A pipe without a partner and a device are not waited
/// for: they are refused with EINVAL, as any other special file and a folder. Empty on failure, with errno set.
Descriptor open_regular(const std::filesystem::path& path, int flags, mode_t mode = 0);

}  // namespace treefarm
