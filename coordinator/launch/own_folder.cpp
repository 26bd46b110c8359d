// SPDX-License-Identifier: Apache-2.0
#include "coordinator/launch/own_folder.h"

#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <system_error>
#include <vector>

#include "common/base/files/atomic_file.h"

namespace treefarm {

namespace {

namespace fs = std::filesystem;

Descriptor open_folder(const fs::path& path) {
    return Descriptor::open(path, O_RDONLY | O_DIRECTORY | O_NOFOLLOW);
}

bool is_still_at(const Descriptor& folder, const fs::path& path) {
    struct stat open {
    }, there{};
    return fstat(folder.fd(), &open) == 0 && lstat(path.c_str(), &there) == 0 && open.st_dev == there.st_dev &&
           open.st_ino == there.st_ino;
}

}  // namespace

OwnFolder::OwnFolder(const fs::path& parent) {
    constexpr int kTries = 100;
    for (int k = 0; k < kTries; ++k) {
        std::string name = (fs::absolute(parent) / (kOwnFolderName + std::to_string(getpid()) + "-XXXXXX")).string();
        if (mkdtemp(name.data()) == nullptr)
            throw FileError(parent.string() + ": no folder can be made in it (" + std::strerror(errno) + ")", errno);
        lock_ = open_folder(name);
        if (lock_) ::flock(lock_.fd(), LOCK_EX);
        path_ = name;
        // A sweep may have taken the new folder for a dead one, and removed it, before it was locked.
        if (!lock_ || is_still_at(lock_, path_)) return;
    }
    throw FileError(parent.string() + ": folders made in it vanish", ENOENT);
}

OwnFolder::~OwnFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

Descriptor lock_of_dead(const fs::path& folder) {
    Descriptor lock = open_folder(folder);
    if (lock && ::flock(lock.fd(), LOCK_EX | LOCK_NB) == 0) return lock;
    return {};
}

void probe_folder(const fs::path& folder) {
    constexpr std::size_t kBytes = 256 << 10;  // more than a render writes before its first pass
    const fs::path file = folder / "probe";
    write_file_atomically(file, std::vector<std::uint8_t>(kBytes), Outlives::process);
    std::error_code ignored;
    fs::remove(file, ignored);
}

}  // namespace treefarm
