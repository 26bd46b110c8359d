#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

namespace treefarm {

/// Writes a file so that a crash at any moment leaves either the old content or the new: temporary file beside it,
/// fsync, rename, fsync of the folder. What is not a regular file (/dev/stdout, a pipe) is written to directly. Throws
/// RunError.
void write_file_atomically(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);

}  // namespace treefarm
