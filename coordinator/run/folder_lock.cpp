// SPDX-License-Identifier: Apache-2.0
#include "coordinator/run/folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <thread>

#include "common/base/timer.h"
#include "common/runs/run_files.h"

namespace treefarm {

namespace {

/// Seconds in which a program that only asks whether the folder is locked has left it again.
constexpr double kGlance = 0.05;

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& folder, double patience, const std::function<bool()>& interrupted)
    : fd_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    if (fd_ >= 0 && ::flock(fd_, LOCK_EX | LOCK_NB) != 0 && errno == EBADF) {  // NFS locks only writable files
        ::close(fd_);
        fd_ = ::open((folder / kLockFileName).c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
    }
    const Timer timer;
    while (fd_ >= 0 && ::flock(fd_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
        if (timer.seconds() > std::max(patience, kGlance) || (interrupted && interrupted())) {
            refused_ = true;
            return;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
}

FolderLock::~FolderLock() {
    if (fd_ >= 0) ::close(fd_);
}

}  // namespace treefarm
