// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <mutex>

namespace treefarm {

/// Lock of a folder for one program, until it is destroyed or its process ends. Not to be moved.
class FolderLock {
  public:
    /// Waits up to `patience` seconds for another owner: the ranks of a killed launcher live on for a moment.
    FolderLock(const std::filesystem::path& folder, double patience, const std::function<bool()>& interrupted);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

    /// Whether another program holds the lock. False on a file system without locks.
    bool refused() const { return refused_; }

    /// Makes the folder again and locks it, if it has been removed or renamed since. Throws FileError if that fails, or
    /// if another program has locked the new folder. May be called by several threads.
    void renew();

  private:
    const std::filesystem::path folder_;
    std::mutex mutex_;  ///< of fd_ after construction
    int fd_;
    bool refused_ = false;
};

}  // namespace treefarm
