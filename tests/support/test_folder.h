// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

namespace treefarm::test {

/// Content of a file; "" if there is none.
std::string read_file(const std::filesystem::path& file);

/// Writes a file, and creates missing folders.
void write_file(const std::filesystem::path& file, const std::string& text);

/// Folder of the running test; created if missing.
std::filesystem::path test_folder();
/// Folder of the running test, emptied.
std::filesystem::path fresh_test_folder();

/// Test with a folder of its own, empty at the beginning.
class FolderTest : public ::testing::Test {
  protected:
    /// Writes a file in the folder.
    std::filesystem::path write(const std::string& name, const std::string& text) const {
        write_file(folder_ / name, text);
        return folder_ / name;
    }
    std::string path(const std::string& name) const { return (folder_ / name).string(); }

    const std::filesystem::path folder_ = fresh_test_folder();
};

}  // namespace treefarm::test
