// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace treefarm {

/// What tells one content of a file from another.
struct FileVersion {
    std::uint64_t inode = 0, bytes = 0;
    std::int64_t nanoseconds = 0;  ///< of its last change, since 1970

    std::string text() const;
};

/// A folder of which files are read, and nothing outside of it ever: paths have no "..", begin at no root and follow no
/// link, neither at their end nor on their way. What is not there, is no plain file or cannot be read is nothing, since
/// files come, change and go while others read.
class ConfinedFolder {
  public:
    explicit ConfinedFolder(std::filesystem::path root) : root_(std::move(root)) {}

    const std::filesystem::path& root() const { return root_; }
    bool is_folder(const std::string& path) const;
    /// A whole file of at most so many bytes.
    std::optional<std::string> read(const std::string& path, std::size_t most) const;
    /// At most so many bytes at the end of a file.
    std::optional<std::string> read_end(const std::string& path, std::size_t most) const;
    std::optional<FileVersion> version(const std::string& path) const;
    /// Names of the folders in a folder, links left out, at most so many.
    std::vector<std::string> folders(const std::string& path, std::size_t most) const;

  private:
    std::filesystem::path root_;
};

/// "a/b" of "a" and "b"; either may be empty.
std::string joined_path(const std::string& folder, const std::string& name);

}  // namespace treefarm
