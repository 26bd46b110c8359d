// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace treefarm {

/// A private folder of this process, mode 0700, for Open MPI's files; removed with it. Its name contains the process,
/// so that sweep() removes it after a kill.
class OwnFolder {
  public:
    /// Makes the folder below `parent`; the path is empty if that fails.
    explicit OwnFolder(const std::filesystem::path& parent);
    ~OwnFolder();
    OwnFolder(const OwnFolder&) = delete;
    OwnFolder& operator=(const OwnFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }
    /// Removes the folder's content.
    void empty() const;

  private:
    std::filesystem::path path_;
};

/// Folders for temporary files: TMPDIR or /tmp, and shared memory.
std::filesystem::path temporary_folder();
std::filesystem::path shared_memory_folder();

/// Removes files that dead processes of this user have left on this host: folders of killed launches, Open MPI's
/// folders of dead launchers, and its shared memory that no process maps. Returns their number.
int sweep();

}  // namespace treefarm
