// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace treefarm {

/// Folders for temporary files: TMPDIR, or /tmp if it names no folder; and shared memory.
std::filesystem::path temporary_folder();
std::filesystem::path shared_memory_folder();

/// Removes files that dead processes of this user have left on this host: folders of killed launches and keys in their
/// run directories, Open MPI's folders of dead launchers, and its shared memory that no process maps. A lock or a lease
/// is the proof that a process is dead, since processes of other containers cannot be seen. Returns their number.
int sweep();

}  // namespace treefarm
