// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>

namespace treefarm {

/// A file that is locked where a folder itself cannot be: on NFS.
inline constexpr const char* kLockFileName = "lock";

/// Keeps a folder for one program at a time, until it is destroyed or its process ends. Not to be moved.
class FolderLock {
  public:
    /// Waits up to `patience` seconds for whoever has the folder: a killed launcher's ranks live on for a moment.
    FolderLock(const std::filesystem::path& folder, double patience, const std::function<bool()>& interrupted);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

    /// Whether another program has the folder. Where the file system knows no locks nobody is known to have it.
    bool refused() const { return refused_; }

  private:
    int fd_;
    bool refused_ = false;
};

}  // namespace treefarm
