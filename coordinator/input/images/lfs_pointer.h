// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace treefarm {

/// Whether a file with this beginning is a Git LFS pointer: the small text that a repository holds instead of a large
/// file (git-lfs/docs/spec.md).
inline bool is_lfs_pointer(std::string_view begin) {
    return begin.starts_with("version https://git-lfs.github.com/spec/");
}

inline constexpr const char* kLfsPointer = "is a pointer of Git LFS, not the file itself";
inline constexpr const char* kLfsCure = "get the file with git lfs pull";

}  // namespace treefarm
