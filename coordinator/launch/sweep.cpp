// SPDX-License-Identifier: Apache-2.0
#include "coordinator/launch/sweep.h"

#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <ctime>
#include <system_error>

#include "common/base/descriptor.h"
#include "common/base/host.h"
#include "common/base/text/parse_text.h"
#include "common/comm/run_key.h"
#include "common/runs/run_files.h"
#include "coordinator/launch/attempt_processes.h"
#include "coordinator/launch/host_keys.h"
#include "coordinator/launch/own_folder.h"
#include "coordinator/run/folder_lock.h"

namespace treefarm {

namespace {

namespace fs = std::filesystem;

/// Whether a file or folder is no link, is of this user, and is at least `age` seconds old.
bool is_ours(const fs::path& path, std::time_t age = 0) {
    struct stat facts {};
    return lstat(path.c_str(), &facts) == 0 && facts.st_uid == geteuid() && !S_ISLNK(facts.st_mode) &&
           std::time(nullptr) - facts.st_ctime >= age;
}

int discard(const fs::path& path) {
    std::error_code error;
    fs::remove_all(path, error);
    return !error;
}

/// Whether no process on this machine, in whatever container, has a file open for writing or mapped: the kernel then
/// grants a lease. False if it cannot tell.
bool is_unused(const fs::path& path) {
    const Descriptor file = Descriptor::open(path, O_RDONLY | O_NOFOLLOW | O_NONBLOCK);
    // Another process that opens the file meanwhile makes the kernel send a signal, of which the default ends a
    // process.
    return file && ::fcntl(file.fd(), F_SETSIG, SIGURG) == 0 && ::fcntl(file.fd(), F_SETLEASE, F_RDLCK) == 0;
}

/// Removes the key that a killed launch has left in its run directory, unless another launch is at work there.
/// `folder`: of the killed one, with a link to the key.
void discard_key(const fs::path& folder) {
    std::error_code error;
    const fs::path key = fs::read_symlink(folder / kRunKeyName, error), place = key.parent_path();
    if (error || key.filename() != kRunKeyName || place.filename() != kLaunchFolder || !is_ours(key)) return;
    if (const FolderLock lock(place, 0.0, nullptr); !lock.refused()) fs::remove(key, error);
}

int sweep_launches(const fs::path& parent) {
    int removed = 0;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(parent, error)) {
        const fs::path& folder = entry.path();
        if (!folder.filename().string().starts_with(kOwnFolderName) || !is_ours(folder)) continue;
        if (const Descriptor lock = lock_of_dead(folder)) {
            discard_key(folder);
            removed += discard(folder);
        }
    }
    return removed;
}

/// Whether no process uses a file of Open MPI's folder for one launcher, which maps files there for its ranks.
bool is_unused_session(const fs::path& folder) {
    std::error_code error;
    for (const auto& entry : fs::recursive_directory_iterator(folder, error))
        if (fs::is_regular_file(entry.symlink_status(error)) && !is_unused(entry.path())) return false;
    return !error;
}

bool has_no_process(std::uint64_t pid) {
    return pid > 0 && pid < (std::uint64_t{1} << 31) && ::kill(static_cast<pid_t>(pid), 0) != 0 && errno == ESRCH;
}

/// Removes TMP/ompi.HOST.UID/pid.123 of a dead mpirun 123; returns their number. Its number may be another's here, or
/// nobody's though it lives in a container, so that its files must be unused, too.
int sweep_sessions() {
    const fs::path sessions =
        temporary_folder() / ("ompi." + fs::path(host_name()).string() + "." + std::to_string(geteuid()));
    if (!is_ours(sessions)) return 0;
    constexpr std::time_t kSeconds = 10;  // between the folder's creation and that of its files
    int removed = 0;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(sessions, error)) {
        const std::string name = entry.path().filename().string();
        if (!name.starts_with("pid.") || !is_ours(entry.path(), kSeconds)) continue;
        const auto pid = parse_unsigned(std::string_view(name).substr(4));
        if (pid && has_no_process(*pid) && is_unused_session(entry.path())) removed += discard(entry.path());
    }
    return removed;
}

/// Removes segments of Open MPI's shared memory that no process maps; returns their number.
int sweep_shared_memory() {
    const std::string start = "vader_segment." + host_name() + "." + std::to_string(geteuid()) + ".";
    int removed = 0;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(shared_memory_folder(), error))
        if (entry.path().filename().string().starts_with(start) && is_ours(entry.path()) && is_unused(entry.path()))
            removed += discard(entry.path());
    return removed;
}

/// Removes keys of attempts without a process here: a launch on another host was killed, or lost this host.
int sweep_keys() {
    constexpr std::time_t kSeconds = 600;  // between a key's arrival and the start of its process
    const std::string start = kHostKeyName;
    int removed = 0;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(temporary_folder(), error)) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with(start) && is_ours(entry.path(), kSeconds) &&
            attempt_processes(name.substr(start.size())).empty())
            removed += discard(entry.path());
    }
    return removed;
}

}  // namespace

fs::path temporary_folder() {
    const char* const asked = std::getenv("TMPDIR");
    std::error_code error;
    // mpirun would make a missing folder, and leave it.
    return asked && fs::is_directory(asked, error) ? fs::absolute(asked) : fs::path("/tmp");
}

fs::path shared_memory_folder() {
    return "/dev/shm";
}

int sweep() {
    return sweep_launches(temporary_folder()) + sweep_launches(shared_memory_folder()) + sweep_sessions() +
           sweep_shared_memory() + sweep_keys();
}

}  // namespace treefarm
