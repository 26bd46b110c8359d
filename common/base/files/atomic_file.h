// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "common/base/error.h"

namespace treefarm {

/// The failure that a written file outlives: of this process, or of the machine's power as well, for which the
/// disk is waited for (a tenth of a second, if it is busy).
enum class Outlives { process, power };

/// A file could not be written, and why: an errno.
class FileError : public RunError {
  public:
    FileError(const std::string& message, int code) : RunError(message), code_(code) {}
    int code() const { return code_; }

  private:
    int code_;
};

/// Writes a file so that a crash at any moment leaves either the old content or the new: temporary file beside it,
/// fsync, rename, fsync of the folder; without either fsync if it need not outlive `power`. The temporary is made as by
/// mkstemp: under a name that nobody can foresee, and never one that is there. An existing file keeps its permissions,
/// a new one follows the umask. What is not a regular file (/dev/stdout, a pipe) is written to directly. Throws
/// FileError.
void write_file_atomically(const std::filesystem::path& path, std::span<const std::uint8_t> bytes,
                           Outlives outlives = Outlives::power);

/// Writes a file as write_file_atomically() does, of a content in pieces.
void write_pieces_atomically(const std::filesystem::path& path, std::span<const std::span<const std::uint8_t>> pieces,
                             Outlives outlives = Outlives::power);

/// Makes a file that was written to outlive the process outlive the power, too, as far as the file system can.
void make_durable(const std::filesystem::path& path);

/// The name is that of a temporary file beside `name`: left by a program that was killed as it wrote.
bool is_temporary_of(const std::string& candidate, const std::string& name);

}  // namespace treefarm
