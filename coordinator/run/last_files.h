// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace treefarm {

/// A file that a run leaves when it ends.
struct LastFile {
    std::string name;             ///< for messages where the failure names no file
    std::function<void()> write;  ///< throws what went wrong
    std::string failure = {};     ///< of the last try; "" once it is written
    bool written = false;
};

/// Tries to write a file; true if it is written, now or before.
bool try_to_write(LastFile& file);

/// Writes the files one after the other, each on its own, and those that fail again and again until `patience` seconds
/// have passed. What could not be written, with the reasons.
std::vector<std::string> write_last_files(std::vector<LastFile>& files, double patience);

}  // namespace treefarm
