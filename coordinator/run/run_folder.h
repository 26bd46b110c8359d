// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "common/config/job.h"
#include "coordinator/run/folder_lock.h"

namespace treefarm {

/// Makes a folder for a render without one: runs/<scene>-<time>, new and owned by this process. Throws
/// std::filesystem::filesystem_error.
std::filesystem::path make_new_run_folder(const std::string& scene_file);

/// Throws InputError if a render or study is running in a folder, whose content is then incomplete.
void refuse_if_at_work(const std::filesystem::path& folder);

/// How a run uses its folder.
enum class FolderUse {
    fresh,    ///< empty or new
    replace,  ///< an earlier run in it may be set aside
    resume,   ///< it belongs to the run that is resumed
};

/// Folder of a run, owned by it: made, locked, and without the files of an earlier run, which are set aside in
/// previous/ (or previous-2, ...) until the new one is done. Not to be moved.
class RunFolder {
  public:
    /// Makes runs/<scene>-<time> if the job names no folder. Throws InputError if the folder is in use, cannot be made,
    /// or its content must not be replaced.
    RunFolder(const Job& job, FolderUse use, const std::function<bool()>& interrupted);

    const std::filesystem::path& path() const { return path_; }
    /// Makes the folder again, locked, if it has been removed. Throws FileError if that fails, or if it belongs to
    /// another program by then. May be called by several threads.
    void renew() const { lock_.renew(); }
    /// Removes the files of this run, unless it resumed them, and restores those that it set aside.
    void give_back() const;
    /// Whether an earlier run is set aside.
    bool has_previous() const;
    /// Removes the earlier run that was set aside, once a better result exists.
    void remove_previous() const;

  private:
    void check() const;
    void remove_leftovers() const;
    void put_aside();

    const FolderUse use_;
    std::filesystem::path path_, aside_;
    mutable FolderLock lock_;
};

}  // namespace treefarm
