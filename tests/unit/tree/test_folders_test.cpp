// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include "tests/support/source_root.h"

namespace {

namespace fs = std::filesystem;

/// Names without their parentheses, so that this file does not call them.
const std::string kTestTools = "TempDir", kSystem = "temp_directory";

/// Makers of folders that no other process has.
const std::set<std::string> kMakers = {"tests/support/test_folder.cpp", "tests/mpi/program.cpp",
                                       "tests/fuzz/xml_fuzz.cpp"};

/// Tests run side by side, so two of them never write into one folder: `test::test_folder()` is the running test's own.
TEST(TestFolders, AreEachTestsOwn) {
    std::size_t files = 0;
    for (const auto& entry : fs::recursive_directory_iterator(treefarm::test::kRoot / "tests")) {
        const std::string file = fs::relative(entry.path(), treefarm::test::kRoot).string();
        if (entry.path().extension() != ".cpp") continue;
        if (kMakers.contains(file)) continue;
        ++files;
        std::ifstream in(entry.path());
        const std::string text{std::istreambuf_iterator<char>(in), {}};
        for (const std::string& place : {kTestTools + "()", kSystem + "_path()"})
            EXPECT_EQ(text.find(place), std::string::npos) << file << ": writes into a folder that others have, too";
    }
    EXPECT_GT(files, 100u);
}

}  // namespace
