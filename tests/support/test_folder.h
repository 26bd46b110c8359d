// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

namespace treefarm::test {

/// The whole text of a file; "" if there is none.
std::string read_file(const std::filesystem::path& file);

/// Writes a file, in folders that need not be there yet.
void write_file(const std::filesystem::path& file, const std::string& text);

/// A folder of the running test alone, which exists.
std::filesystem::path test_folder();
/// The test's folder, emptied.
std::filesystem::path fresh_test_folder();

/// A test with a folder of its own, which is empty when it begins.
class FolderTest : public ::testing::Test {
  protected:
    /// Writes a file of the folder.
    std::filesystem::path write(const std::string& name, const std::string& text) const {
        write_file(folder_ / name, text);
        return folder_ / name;
    }
    std::string path(const std::string& name) const { return (folder_ / name).string(); }

    const std::filesystem::path folder_ = fresh_test_folder();
};

}  // namespace treefarm::test
