// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace treefarm {

/// Identity of a file's content, for detecting changes.
struct FileVersion {
    std::uint64_t inode = 0, bytes = 0;
    std::int64_t nanoseconds = 0;  ///< time of its last change, since 1970

    std::string text() const;
};

/// Read access to the files of a folder, and to nothing outside of it: paths have no "..", are relative, and follow no
/// link, neither at their end nor in between. A missing, special or unreadable file is no value, since files may
/// appear, change and vanish at any time.
class ConfinedFolder {
  public:
    explicit ConfinedFolder(std::filesystem::path root) : root_(std::move(root)) {}

    const std::filesystem::path& root() const { return root_; }
    bool is_folder(const std::string& path) const;
    /// Content of a whole file of at most `most` bytes.
    std::optional<std::string> read(const std::string& path, std::size_t most) const;
    /// At most `most` bytes at the end of a file.
    std::optional<std::string> read_end(const std::string& path, std::size_t most) const;
    std::optional<FileVersion> version(const std::string& path) const;
    /// Whether a program holds the lock of a folder (FolderLock), in whatever container of this machine.
    bool is_locked(const std::string& path) const;
    /// Names of a folder's subfolders, at most `most`, without links.
    std::vector<std::string> folders(const std::string& path, std::size_t most) const;

  private:
    std::filesystem::path root_;
};

/// Path "a/b" of "a" and "b"; either may be empty.
std::string joined_path(const std::string& folder, const std::string& name);

}  // namespace treefarm
