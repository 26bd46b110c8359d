// SPDX-License-Identifier: Apache-2.0
#include "serve/confined_folder.h"

#include <dirent.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <memory>
#include <string_view>

#include "common/base/descriptor.h"
#include "common/runs/run_files.h"

namespace treefarm {

namespace {

/// Names of a relative path; no value if it could lead outside.
std::optional<std::vector<std::string>> names_of(const std::string& path) {
    std::vector<std::string> names;
    if (path.empty()) return names;
    if (path.find('\0') != std::string::npos) return std::nullopt;
    for (std::size_t begin = 0; begin <= path.size();) {
        const std::size_t end = std::min(path.find('/', begin), path.size());
        const std::string name = path.substr(begin, end - begin);
        if (name.empty() || name == "." || name == "..") return std::nullopt;
        names.push_back(name);
        begin = end + 1;
    }
    return names;
}

constexpr int kFolder = O_RDONLY | O_DIRECTORY | O_CLOEXEC;

/// Opens a path without following links. The root itself may be a link: it was named by the user who started the
/// program.
Descriptor open_within(const std::filesystem::path& root, const std::string& path, int flags) {
    const auto names = names_of(path);
    if (!names) return Descriptor(-1);
    Descriptor at(::open(root.c_str(), kFolder));  // each time: a render recreates its folder if it vanished
    for (std::size_t k = 0; k < names->size() && at; ++k) {
        const bool is_last = k + 1 == names->size();
        at = Descriptor(::openat(at.fd(), (*names)[k].c_str(), (is_last ? flags : kFolder) | O_NOFOLLOW));
    }
    return at;
}

/// Opens a regular file; O_NONBLOCK, so that a pipe blocks no thread.
Descriptor open_file(const std::filesystem::path& root, const std::string& path, struct stat& facts) {
    if (path.empty()) return Descriptor(-1);
    Descriptor file = open_within(root, path, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    if (file && (::fstat(file.fd(), &facts) != 0 || !S_ISREG(facts.st_mode))) return Descriptor(-1);
    return file;
}

/// Up to `size` bytes from `offset` on.
std::string read_part(int file, std::size_t size, std::size_t offset) {
    std::string text(size, '\0');
    std::size_t done = 0;
    while (done < size) {
        const ssize_t got = ::pread(file, text.data() + done, size - done, static_cast<off_t>(offset + done));
        if (got <= 0) break;  // the file was truncated, or its disk is gone
        done += static_cast<std::size_t>(got);
    }
    text.resize(done);
    return text;
}

}  // namespace

std::string FileVersion::text() const {
    return std::to_string(inode) + "-" + std::to_string(nanoseconds) + "-" + std::to_string(bytes);
}

bool ConfinedFolder::is_folder(const std::string& path) const {
    return static_cast<bool>(open_within(root_, path, kFolder));
}

std::optional<std::string> ConfinedFolder::read(const std::string& path, std::size_t most) const {
    struct stat facts {};
    const Descriptor file = open_file(root_, path, facts);
    if (!file || static_cast<std::size_t>(facts.st_size) > most) return std::nullopt;
    return read_part(file.fd(), static_cast<std::size_t>(facts.st_size), 0);
}

std::optional<std::string> ConfinedFolder::read_end(const std::string& path, std::size_t most) const {
    struct stat facts {};
    const Descriptor file = open_file(root_, path, facts);
    if (!file) return std::nullopt;
    const std::size_t size = static_cast<std::size_t>(facts.st_size), part = std::min(size, most);
    return read_part(file.fd(), part, size - part);
}

std::optional<FileVersion> ConfinedFolder::version(const std::string& path) const {
    struct stat facts {};
    if (!open_file(root_, path, facts)) return std::nullopt;
    return FileVersion{facts.st_ino, static_cast<std::uint64_t>(facts.st_size),
                       facts.st_mtim.tv_sec * std::int64_t{1000000000} + facts.st_mtim.tv_nsec};
}

bool ConfinedFolder::is_locked(const std::string& path) const {
    const auto is_held = [](const Descriptor& lock) {
        return lock && ::flock(lock.fd(), LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    };
    struct stat facts {};
    // The file is for network file systems.
    return is_held(open_within(root_, path, kFolder)) ||
           is_held(open_file(root_, joined_path(path, kLockFileName), facts));
}

std::vector<std::string> ConfinedFolder::folders(const std::string& path, std::size_t most) const {
    std::vector<std::string> names;
    Descriptor folder = open_within(root_, path, kFolder);
    if (!folder) return names;
    const std::unique_ptr<DIR, int (*)(DIR*)> entries(::fdopendir(folder.fd()), &::closedir);
    if (!entries) return names;
    folder.release();
    for (const dirent* entry = ::readdir(entries.get()); entry && names.size() < most;
         entry = ::readdir(entries.get())) {
        const std::string_view name = entry->d_name;
        if (name == "." || name == "..") continue;
        struct stat facts {};
        const bool known = entry->d_type != DT_UNKNOWN;
        if (known ? entry->d_type == DT_DIR
                  : ::fstatat(::dirfd(entries.get()), entry->d_name, &facts, AT_SYMLINK_NOFOLLOW) == 0 &&
                        S_ISDIR(facts.st_mode))
            names.emplace_back(name);
    }
    std::sort(names.begin(), names.end());
    return names;
}

std::string joined_path(const std::string& folder, const std::string& name) {
    return folder.empty() || name.empty() ? folder + name : folder + "/" + name;
}

}  // namespace treefarm
