// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "common/config/job.h"
#include "coordinator/run/folder_lock.h"

namespace treefarm {

/// A folder for a render of this scene that names none, runs/<scene>-<time>: made, and nobody else's. Throws
/// std::filesystem::filesystem_error.
std::filesystem::path make_new_run_folder(const std::string& scene_file);

/// Throws InputError where a render or study is at work in a folder: what it holds so far says little.
void refuse_if_at_work(const std::filesystem::path& folder);

/// Whose folder a run takes.
enum class FolderUse {
    fresh,    ///< an empty or a new one
    replace,  ///< an earlier run in it may be put aside
    resume,   ///< that of the run which goes on
};

/// The folder of a run as its own: made, locked, and without the files of an earlier run, which lie in previous/ (or
/// previous-2, ...) until the new one is done. Not to be moved.
class RunFolder {
  public:
    /// runs/<scene>-<time> if the job names none. Throws InputError where the folder is in use, cannot be made, or
    /// holds what must not be replaced.
    RunFolder(const Job& job, FolderUse use, const std::function<bool()>& interrupted);

    const std::filesystem::path& path() const { return path_; }
    /// Removes the files of this run, unless it went on with them, and puts back those that it put aside.
    void give_back() const;
    /// An earlier run lies aside.
    bool has_previous() const;
    /// Removes what lies aside: something better is there.
    void remove_previous() const;

  private:
    void check() const;
    void remove_leftovers() const;
    void put_aside();

    const FolderUse use_;
    std::filesystem::path path_, aside_;
    FolderLock lock_;
};

}  // namespace treefarm
