// SPDX-License-Identifier: Apache-2.0
#include "common/comm/private_file.h"

#include <fcntl.h>
#include <sodium.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "common/base/descriptor.h"
#include "common/base/error.h"
#include "common/base/files/atomic_file.h"

namespace treefarm {

namespace {

namespace fs = std::filesystem;

/// A name that is_temporary_of() recognises, so that the next run removes the file of a killed one.
fs::path temporary_of(const fs::path& path) {
    if (sodium_init() < 0) throw RunError("libsodium finds no source of random numbers");
    unsigned char random[6];
    randombytes_buf(random, sizeof random);
    char letters[2 * sizeof random + 1];
    sodium_bin2hex(letters, sizeof letters, random, sizeof random);
    fs::path temporary = path;
    temporary += std::string(".tmp-") + letters;
    return temporary;
}

/// Writes a new file. The umask may have denied the owner access, and some file systems grant everyone access.
bool write_new(const fs::path& path, const std::string& text) {
    const Descriptor file = Descriptor::open(path, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW, 0600);
    struct stat status {};
    if (!file || ::fchmod(file.fd(), 0600) != 0 || ::fstat(file.fd(), &status) != 0) return false;
    const ssize_t written = ::write(file.fd(), text.data(), text.size());
    if (written != static_cast<ssize_t>(text.size())) {
        if (written >= 0) errno = ENOSPC;
        return false;
    }
    if ((status.st_mode & 077) != 0) errno = EPERM;
    return (status.st_mode & 077) == 0;
}

/// Throws InputError if another user could have read or made the file.
void check_owner(const fs::path& path, const struct stat& status, const std::string& cure) {
    if (!S_ISREG(status.st_mode)) throw InputError(Location{path.string(), 0, 0}, "is no file", cure);
    if (status.st_uid != ::geteuid())
        throw InputError(Location{path.string(), 0, 0}, "belongs to another user, who may have made it up",
                         "work as the user who renders");
    if ((status.st_mode & 077) != 0)
        throw InputError(Location{path.string(), 0, 0}, "can be read by other users, and holds a secret",
                         "chmod 600 it, and start the render again if somebody may have read it");
}

}  // namespace

void write_private_file(const fs::path& path, const std::string& text) {
    const fs::path temporary = temporary_of(path);
    if (write_new(temporary, text) && ::rename(temporary.c_str(), path.c_str()) == 0) return;
    const int error = errno;
    ::unlink(temporary.c_str());
    throw FileError(path.string() + ": cannot be written: " + std::strerror(error), error);
}

std::string read_private_file(const fs::path& path, std::size_t most_bytes, const std::string& cure) {
    const Descriptor file = Descriptor::open(path, O_RDONLY | O_NONBLOCK);
    struct stat status {};
    const auto refuse = [&] {
        throw InputError(Location{path.string(), 0, 0}, std::string("cannot be read: ") + std::strerror(errno), cure);
    };
    if (!file || ::fstat(file.fd(), &status) != 0) refuse();
    check_owner(path, status, cure);
    std::string text(most_bytes, '\0');
    const ssize_t length = ::read(file.fd(), text.data(), text.size());
    if (length < 0) refuse();
    text.resize(static_cast<std::size_t>(length));
    return text;
}

}  // namespace treefarm
