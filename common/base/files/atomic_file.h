// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "common/base/error.h"

namespace treefarm {

/// Failure that a written file must survive: the end of this process, or also a loss of power, which means waiting for
/// the disk (a tenth of a second if it is busy).
enum class Outlives { process, power };

/// Error of writing a file, with the errno.
class FileError : public RunError {
  public:
    FileError(const std::string& message, int code) : RunError(message), code_(code) {}
    int code() const { return code_; }

  private:
    int code_;
};

/// Whether an errno is of a disk that may take files later: full, above its quota, or out of reach. A user's input is
/// not to blame then.
bool is_disk_trouble(int code);

/// Writes a file such that a crash at any moment leaves either the old content or the new: temporary file in the same
/// folder, fsync, rename, fsync of the folder (without the fsyncs unless it must survive `power`). The temporary file
/// is created as by mkstemp, under an unpredictable name. An existing file keeps its permissions; a new one follows the
/// umask. For the program's own files: a link in its place is replaced, and its target stays as it is. Throws
/// FileError, also if a folder, a pipe or a device is there.
void write_file_atomically(const std::filesystem::path& path, std::span<const std::uint8_t> bytes,
                           Outlives outlives = Outlives::power);

/// Writes a file as write_file_atomically() does, from several pieces.
void write_pieces_atomically(const std::filesystem::path& path, std::span<const std::span<const std::uint8_t>> pieces,
                             Outlives outlives = Outlives::power);

/// Writes a file that the user named, as write_file_atomically() does, but through a link, whose target is replaced,
/// and directly to a path that is no regular file (/dev/stdout, a pipe). Throws FileError.
void write_output_file(const std::filesystem::path& path, std::span<const std::uint8_t> bytes,
                       Outlives outlives = Outlives::power);

/// Makes a file that survives the process survive a loss of power, too, as far as the file system allows.
void make_durable(const std::filesystem::path& path);

/// Whether a name is that of a temporary file for `name`, left by a program that was killed while writing.
bool is_temporary_of(const std::string& candidate, const std::string& name);

}  // namespace treefarm
