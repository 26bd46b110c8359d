#include "common/image/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "common/base/error.h"

namespace treefarm {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const fs::path& path, const char* action, int error) {
    throw RunError(path.string() + ": cannot " + action + " (" + std::strerror(error) +
                   "); check that the folder exists, is writable and has space");
}

/// Closes on every way out.
class Descriptor {
  public:
    Descriptor(const fs::path& path, int flags) : fd_(::open(path.c_str(), flags | O_CLOEXEC, 0644)) {}
    ~Descriptor() {
        if (fd_ >= 0) ::close(fd_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;

    int get() const { return fd_; }
    bool valid() const { return fd_ >= 0; }
    /// A full network file system may report only here.
    bool close() {
        const int fd = fd_;
        fd_ = -1;
        return ::close(fd) == 0;
    }

  private:
    int fd_;
};

/// 0, or the errno of the call that failed.
int write_all(int fd, std::span<const std::uint8_t> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(fd, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return written < 0 ? errno : EIO;
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return 0;
}

int write_whole(const fs::path& path, std::span<const std::uint8_t> bytes, Outlives outlives) {
    Descriptor file(path, O_WRONLY | O_CREAT | O_TRUNC);
    if (!file.valid()) return errno;
    if (const int error = write_all(file.get(), bytes)) return error;
    if (outlives == Outlives::power && ::fsync(file.get()) != 0) return errno;
    return file.close() ? 0 : errno;
}

void write_special(const fs::path& path, std::span<const std::uint8_t> bytes) {
    const Descriptor file(path, O_WRONLY);
    const int error = file.valid() ? write_all(file.get(), bytes) : errno;
    if (error != 0) fail(path, "write", error);
}

}  // namespace

void write_file_atomically(const fs::path& path, std::span<const std::uint8_t> bytes, Outlives outlives) {
    std::error_code none;
    const fs::file_status status = fs::status(path, none);
    if (fs::is_directory(status)) fail(path, "write", EISDIR);
    if (fs::exists(status) && !fs::is_regular_file(status)) return write_special(path, bytes);

    // A symbolic link stays one: its target is replaced.
    const fs::path target = fs::exists(status) ? fs::canonical(path, none) : path;
    fs::path temporary = target;
    temporary += ".tmp" + std::to_string(::getpid());
    int error = write_whole(temporary, bytes, outlives);
    if (error == 0 && ::rename(temporary.c_str(), target.c_str()) != 0) error = errno;
    if (error != 0) {
        ::unlink(temporary.c_str());
        fail(path, "write", error);
    }
    if (outlives != Outlives::power) return;
    // The rename itself is durable once its folder is; some file systems refuse to sync a folder, which loses nothing.
    const fs::path folder = target.parent_path();
    const Descriptor directory(folder.empty() ? fs::path(".") : folder, O_RDONLY | O_DIRECTORY);
    if (directory.valid()) ::fsync(directory.get());
}

}  // namespace treefarm
