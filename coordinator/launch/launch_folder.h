// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "cli/launched_command.h"
#include "coordinator/run/folder_lock.h"
#include "coordinator/run/life_status.h"

namespace treefarm {

/// The run directory of what is launched, and launch's own folder in it: signs of life, hostfiles, what mpirun said.
class LaunchFolder {
  public:
    /// Makes both; a render that names no folder gets one, and says so in its words from now on. Throws InputError
    /// where that cannot be, or another launch is at work there.
    explicit LaunchFolder(LaunchedCommand& command);

    const std::filesystem::path& run() const { return run_; }
    std::filesystem::path own() const { return run_ / kLaunchFolder; }
    /// Where the coordinator's sign of life goes: a whole path, for other hosts.
    std::filesystem::path life_file() const { return std::filesystem::absolute(own() / "status.json"); }

    /// The sign of life that is there; sets `readable` to whether it could be looked for.
    std::optional<LifeStatus> life(bool& readable) const;
    /// Exit code by the summary.json of this attempt; nothing where there is none.
    std::optional<int> summary(const std::string& attempt) const;
    /// Whether an attempt of this launch has had the run directory.
    bool was_taken_by(const std::string& launch) const;
    /// Generation of the newest checkpoint; 0: there is none.
    std::uint64_t checkpoint() const;

    /// Removes what this launch has made, where nothing else came of it.
    void give_back() const;

  private:
    std::filesystem::path run_;
    bool made_run_ = false, made_own_ = false;
    std::optional<FolderLock> lock_;
};

}  // namespace treefarm
