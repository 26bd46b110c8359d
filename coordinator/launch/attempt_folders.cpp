// SPDX-License-Identifier: Apache-2.0
#include "coordinator/launch/attempt_folders.h"

#include <cerrno>
#include <system_error>

#include "common/base/files/atomic_file.h"
#include "common/comm/run_key.h"
#include "coordinator/launch/sweep.h"

namespace treefarm {

namespace {

namespace fs = std::filesystem;

/// Throws FileError if a folder cannot hold the shared memory of so many processes: Open MPI takes some 4 MiB for each.
void check_room(const fs::path& folder, int processes) {
    constexpr std::uintmax_t kBytes = 8 << 20;
    std::error_code error;
    const fs::space_info space = fs::space(folder, error);
    if (error) throw FileError(folder.string() + ": " + error.message(), error.value());
    if (space.available < static_cast<std::uintmax_t>(processes) * kBytes)
        throw FileError(folder.string() + ": has no room for the shared memory of the processes", ENOSPC);
}

}  // namespace

AttemptFolders::AttemptFolders(StartPlan& plan, const fs::path& key) {
    try {
        temporary_ = std::make_unique<OwnFolder>(temporary_folder());
        std::error_code none;
        fs::create_symlink(fs::absolute(key), temporary_->path() / kRunKeyName, none);
        probe_folder(temporary_->path());
    } catch (const FileError&) {
        if (plan.starter == Starter::mpirun) throw;
    }
    if (plan.starter != Starter::mpirun) return;
    plan.temporary = plan.shared_memory = temporary_->path();
    try {
        check_room(shared_memory_folder(), plan.processes);
        shared_memory_ = std::make_unique<OwnFolder>(shared_memory_folder());
        plan.shared_memory = shared_memory_->path();
    } catch (const FileError& error) {
        trouble_ = error.what();
    }
}

}  // namespace treefarm
