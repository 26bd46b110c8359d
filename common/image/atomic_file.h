#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

namespace treefarm {

/// What a file outlives once it is written: this process, or the machine's power as well, for which the disk is waited
/// for (a tenth of a second, if it is busy).
enum class Outlives { process, power };

/// Writes a file so that a crash at any moment leaves either the old content or the new: temporary file beside it,
/// fsync, rename, fsync of the folder; without either fsync if it need not outlive `power`. What is not a regular file
/// (/dev/stdout, a pipe) is written to directly. Throws RunError.
void write_file_atomically(const std::filesystem::path& path, std::span<const std::uint8_t> bytes,
                           Outlives outlives = Outlives::power);

}  // namespace treefarm
