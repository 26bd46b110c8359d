// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "common/config/job.h"
#include "coordinator/folder_lock.h"

namespace treefarm {

/// The folder of a run as its own: made, locked, and without the files of an earlier run, which lie in previous/ (or
/// previous-2, ...) until the new one is done. Not to be moved.
class RunFolder {
  public:
    /// runs/<scene>-<time> if the job names none. `overwrite`: an earlier run may be put aside. Throws InputError where
    /// the folder is in use, cannot be made, or holds what must not be replaced.
    RunFolder(const Job& job, bool overwrite, const std::function<bool()>& interrupted);

    const std::filesystem::path& path() const { return path_; }
    /// Removes the files of this run, and puts back those that it put aside.
    void give_back() const;
    /// An earlier run lies aside.
    bool has_previous() const;
    /// Removes what lies aside: something better is there.
    void remove_previous() const;

  private:
    void check(bool overwrite) const;
    void remove_leftovers() const;
    void put_aside();

    std::filesystem::path path_, aside_;
    FolderLock lock_;
};

}  // namespace treefarm
