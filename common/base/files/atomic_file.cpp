// SPDX-License-Identifier: Apache-2.0
#include "common/base/files/atomic_file.h"

#include <fcntl.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "common/base/descriptor.h"

namespace treefarm {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const fs::path& path, const char* action, int error) {
    throw FileError(path.string() + ": cannot " + action + " (" + std::strerror(error) +
                        "); check that the folder exists, is writable and has space",
                    error);
}

using Pieces = std::span<const std::span<const std::uint8_t>>;

/// Writes all pieces. Returns 0, or the errno of the failed call.
int write_all(int fd, Pieces pieces) {
    for (std::span<const std::uint8_t> bytes : pieces)
        while (!bytes.empty()) {
            const ssize_t written = ::write(fd, bytes.data(), bytes.size());
            if (written < 0 && errno == EINTR) continue;
            if (written <= 0) return written < 0 ? errno : EIO;
            bytes = bytes.subspan(static_cast<std::size_t>(written));
        }
    return 0;
}

constexpr char kTemporaryMark[] = ".tmp-";
constexpr std::size_t kTemporaryLetters = 12;

/// Name of a temporary file in the folder of `target`: there, renaming is atomic.
fs::path temporary_name(const fs::path& target) {
    constexpr char letters[] = "abcdefghijklmnopqrstuvwxyz012345";  // 32
    std::uint8_t random[kTemporaryLetters] = {};
    if (::getrandom(random, sizeof random, 0) != static_cast<ssize_t>(sizeof random)) fail(target, "write", errno);
    std::string end = kTemporaryMark;
    for (const std::uint8_t byte : random)
        end += letters[byte % 32];
    return fs::path(target) += end;
}

int write_whole(const fs::path& path, Pieces pieces, Outlives outlives, const fs::file_status& old) {
    const bool replaces = fs::is_regular_file(old);
    const auto mode = replaces ? static_cast<mode_t>(old.permissions() & fs::perms::all) : mode_t{0666};
    // O_EXCL opens neither an existing file nor a link.
    Descriptor file = Descriptor::open(path, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW, mode);
    if (!file) return errno;
    if (replaces) ::fchmod(file.fd(), mode);  // some file systems have no permissions to set; that loses nothing
    if (const int error = write_all(file.fd(), pieces)) return error;
    if (outlives == Outlives::power && ::fsync(file.fd()) != 0) return errno;
    return file.close() ? 0 : errno;
}

/// Syncs the folder of a file, which makes the rename durable; some file systems refuse that, which loses nothing.
void sync_folder(const fs::path& file) {
    const fs::path folder = file.parent_path();
    const Descriptor directory = Descriptor::open(folder.empty() ? fs::path(".") : folder, O_RDONLY | O_DIRECTORY);
    if (directory) ::fsync(directory.fd());
}

void write_special(const fs::path& path, Pieces pieces) {
    const Descriptor file = Descriptor::open(path, O_WRONLY);
    const int error = file ? write_all(file.fd(), pieces) : errno;
    if (error != 0) fail(path, "write", error);
}

}  // namespace

bool is_disk_trouble(int code) {
    return code == ENOSPC || code == EDQUOT || code == EIO || code == ESTALE;
}

void write_file_atomically(const fs::path& path, std::span<const std::uint8_t> bytes, Outlives outlives) {
    write_pieces_atomically(path, {&bytes, 1}, outlives);
}

void write_pieces_atomically(const fs::path& path, Pieces pieces, Outlives outlives) {
    std::error_code none;
    const fs::file_status old = fs::symlink_status(path, none);
    if (fs::is_directory(old)) fail(path, "write", EISDIR);
    if (fs::exists(old) && !fs::is_regular_file(old) && !fs::is_symlink(old))
        throw FileError(path.string() + ": is a pipe or a device, not a file; remove it", EINVAL);
    const fs::path temporary = temporary_name(path);
    int error = write_whole(temporary, pieces, outlives, old);
    if (error == 0 && ::rename(temporary.c_str(), path.c_str()) != 0) error = errno;
    if (error != 0) {
        if (error != EEXIST) ::unlink(temporary.c_str());
        fail(path, "write", error);
    }
    if (outlives == Outlives::power) sync_folder(path);
}

void write_output_file(const fs::path& path, std::span<const std::uint8_t> bytes, Outlives outlives) {
    std::error_code none;
    const fs::file_status status = fs::status(path, none);
    if (fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status))
        return write_special(path, {&bytes, 1});
    write_file_atomically(fs::exists(status) ? fs::canonical(path, none) : path, bytes, outlives);
}

void make_durable(const fs::path& path) {
    {
        const Descriptor file = Descriptor::open(path, O_RDONLY | O_NONBLOCK);  // a pipe would wait for its other end
        if (file) ::fsync(file.fd());
    }
    sync_folder(path);
}

bool is_temporary_of(const std::string& candidate, const std::string& name) {
    const std::string start = name + kTemporaryMark;
    return candidate.starts_with(start) && candidate.size() == start.size() + kTemporaryLetters;
}

}  // namespace treefarm
