// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace treefarm {

/// A folder of this process alone, mode 0700, for what Open MPI leaves; removed with it. Its name says whose it is, so
/// that sweep() removes it where its process was killed.
class OwnFolder {
  public:
    /// Below `parent`; has no path where it cannot be made.
    explicit OwnFolder(const std::filesystem::path& parent);
    ~OwnFolder();
    OwnFolder(const OwnFolder&) = delete;
    OwnFolder& operator=(const OwnFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }
    /// Removes what is in it.
    void empty() const;

  private:
    std::filesystem::path path_;
};

/// Folders for temporary files: TMPDIR or /tmp, and shared memory.
std::filesystem::path temporary_folder();
std::filesystem::path shared_memory_folder();

/// Removes what dead processes of this user have left on this host: folders of killed launches, Open MPI's folders of
/// dead launchers, and its shared memory that no process maps. Returns how many there were.
int sweep();

}  // namespace treefarm
