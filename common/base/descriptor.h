// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <filesystem>
#include <utility>

namespace treefarm {

/// A file descriptor, closed on every way out; -1: none.
class Descriptor {
  public:
    Descriptor() = default;
    explicit Descriptor(int fd) : fd_(fd) {}
    /// An opened file, which no child process inherits; none where it cannot be opened, with errno.
    static Descriptor open(const std::filesystem::path& path, int flags, mode_t mode = 0) {
        return Descriptor(::open(path.c_str(), flags | O_CLOEXEC, mode));
    }
    Descriptor(Descriptor&& other) noexcept : fd_(other.release()) {}
    Descriptor& operator=(Descriptor&& other) noexcept {
        std::swap(fd_, other.fd_);
        return *this;
    }
    ~Descriptor() {
        if (fd_ >= 0) ::close(fd_);
    }

    int fd() const { return fd_; }
    explicit operator bool() const { return fd_ >= 0; }
    int release() { return std::exchange(fd_, -1); }
    /// Closes it now: a full network file system may report only here. False if it does, with errno.
    bool close() { return ::close(release()) == 0; }

  private:
    int fd_ = -1;
};

}  // namespace treefarm
