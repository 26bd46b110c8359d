// SPDX-License-Identifier: Apache-2.0
#include "coordinator/run/folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <system_error>
#include <thread>

#include "common/base/files/atomic_file.h"
#include "common/base/timer.h"
#include "common/runs/run_files.h"

namespace treefarm {

namespace {

/// Seconds in which a program that only asks whether the folder is locked has left it again.
constexpr double kGlance = 0.05;

/// Descriptor of what is locked, locked where possible: the folder, or a file in it; -1 if there is none.
int open_locked(const std::filesystem::path& folder) {
    const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (fd < 0 || ::flock(fd, LOCK_EX | LOCK_NB) == 0 || errno != EBADF) return fd;
    ::close(fd);  // NFS locks only writable files
    return ::open((folder / kLockFileName).c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
}

bool is_same_file(const struct stat& a, const std::filesystem::path& path) {
    struct stat b {};
    return ::stat(path.c_str(), &b) == 0 && a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& folder, double patience, const std::function<bool()>& interrupted)
    : folder_(folder), fd_(open_locked(folder)) {
    const Timer timer;
    while (fd_ >= 0 && ::flock(fd_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
        if (timer.seconds() > std::max(patience, kGlance) || (interrupted && interrupted())) {
            refused_ = true;
            return;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
}

void FolderLock::renew() {
    const std::lock_guard guard(mutex_);
    struct stat locked {};
    if (fd_ >= 0 && ::fstat(fd_, &locked) == 0 &&
        (is_same_file(locked, folder_) || is_same_file(locked, folder_ / kLockFileName)))
        return;
    std::error_code none;  // what fails is told by whoever writes
    std::filesystem::create_directories(folder_, none);
    if (fd_ < 0) return;
    const int fd = open_locked(folder_);
    if (fd < 0)
        throw FileError(folder_.string() + ": cannot be made again: " + std::generic_category().message(errno), errno);
    if (::flock(fd, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
        ::close(fd);
        throw FileError(folder_.string() + ": was removed, and belongs to another render or study now", EBUSY);
    }
    ::close(fd_);
    fd_ = fd;
}

FolderLock::~FolderLock() {
    if (fd_ >= 0) ::close(fd_);
}

}  // namespace treefarm
