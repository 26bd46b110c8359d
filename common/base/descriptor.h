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
    /// Opens a file; child processes do not inherit the descriptor. Empty on failure, with errno set.
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
    /// Closes the descriptor early and reports errors, since a full network file system may report them only on close.
    /// False on failure, with errno set.
    bool close() { return ::close(release()) == 0; }

  private:
    int fd_ = -1;
};

}  // namespace treefarm
