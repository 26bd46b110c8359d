// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace treefarm {

/// A file that a run writes when it ends.
struct LastFile {
    std::string name;             ///< for messages, if the failure names no file
    std::function<void()> write;  ///< throws on failure
    std::string failure = {};     ///< of the last attempt; "" once it is written
    bool written = false;
};

/// Attempts to write a file; true if it is written, now or before.
bool try_to_write(LastFile& file);

/// Writes the files one after the other, and retries those that fail until `patience` seconds have passed. Returns the
/// files that could not be written, with the reasons.
std::vector<std::string> write_last_files(std::vector<LastFile>& files, double patience);

}  // namespace treefarm
