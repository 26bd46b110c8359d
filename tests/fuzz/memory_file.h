// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace treefarm::fuzz {

/// Bytes as a file in memory, for readers that want a path: nothing is written to a disk.
class MemoryFile {
  public:
    MemoryFile() : MemoryFile(nullptr, 0) {}
    MemoryFile(const std::uint8_t* data, std::size_t size);
    ~MemoryFile();
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;

    /// Replaces the file's content.
    void assign(const std::uint8_t* data, std::size_t size);

    const std::filesystem::path& path() const { return path_; }

  private:
    int descriptor_;
    std::filesystem::path path_;
};

}  // namespace treefarm::fuzz
