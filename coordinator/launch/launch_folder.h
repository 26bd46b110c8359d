// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "common/runs/run_files.h"
#include "coordinator/launch/launched_command.h"
#include "coordinator/run/folder_lock.h"
#include "coordinator/run/life_status.h"

namespace treefarm {

/// Run directory of a launched command, with launch's own subfolder: heartbeats, hostfiles, mpirun's output.
class LaunchFolder {
  public:
    /// Makes both folders; a render without a folder gets one, added to its command line. Throws InputError if that
    /// fails, or another launch is running there.
    explicit LaunchFolder(LaunchedCommand& command);

    const std::filesystem::path& run() const { return run_; }
    std::filesystem::path own() const { return run_ / kLaunchFolder; }
    /// Heartbeat file of the coordinator: an absolute path, for other hosts.
    std::filesystem::path life_file() const { return std::filesystem::absolute(own() / kStatusFile); }

    /// Makes folders again that have vanished, as far as that is possible.
    void remake();
    /// Reason why no file can be written to the run directory; "" if one can. Makes its folders again.
    std::string trouble();

    /// Content of the heartbeat file; sets `readable` to whether it could be looked for.
    std::optional<LifeStatus> life(bool& readable) const;
    /// Exit code in the summary.json of this attempt; no value without one.
    std::optional<int> summary(const std::string& attempt) const;
    /// Whether an attempt of this launch has owned the run directory.
    bool was_taken_by(const std::string& launch) const;
    /// Generation of the newest checkpoint; 0: none.
    std::uint64_t checkpoint() const;

    /// Removes the folders that this launch has made, if they have no other content.
    void give_back() const;

  private:
    std::filesystem::path run_;
    bool made_run_ = false, made_own_ = false;
    std::optional<FolderLock> lock_;
};

}  // namespace treefarm
