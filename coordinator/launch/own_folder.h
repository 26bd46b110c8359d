// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "common/base/descriptor.h"

namespace treefarm {

/// Prefix of the names of OwnFolders; the process and a random end follow.
inline constexpr const char* kOwnFolderName = "treefarm-launch-";

/// A private folder of this process, mode 0700, for files of an attempt; removed with it. The process holds the
/// folder's lock, by which sweep() tells it from what a killed process has left, in any container of this machine.
class OwnFolder {
  public:
    /// Makes the folder below `parent`. Throws FileError.
    explicit OwnFolder(const std::filesystem::path& parent);
    ~OwnFolder();
    OwnFolder(const OwnFolder&) = delete;
    OwnFolder& operator=(const OwnFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
    Descriptor lock_;
};

/// Lock of an OwnFolder whose process has ended; empty if it lives, or the file system has no locks.
Descriptor lock_of_dead(const std::filesystem::path& folder);

/// Writes a small file to a folder and removes it. Throws FileError if the folder is missing or full, or refuses files.
void probe_folder(const std::filesystem::path& folder);

}  // namespace treefarm
