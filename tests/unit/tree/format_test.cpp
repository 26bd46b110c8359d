// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/support/command.h"
#include "tests/support/source_root.h"
#include "tests/support/test_folder.h"

namespace {

namespace fs = std::filesystem;

using treefarm::test::kRoot;
constexpr int kMostLines = 400;

std::vector<fs::path> formatted_sources() {
    std::vector<fs::path> files;
    for (const char* folder : {"common", "coordinator", "worker", "report", "serve", "cli", "tests", "bench"}) {
        if (!fs::exists(kRoot / folder)) continue;
        for (const auto& entry : fs::recursive_directory_iterator(kRoot / folder))
            if (entry.path().extension() == ".h" || entry.path().extension() == ".cpp") files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    return files;
}

treefarm::test::Ended clang_format(const std::vector<fs::path>& files) {
    std::string command = "cd '" + kRoot.string() + "' && clang-format --style=file --dry-run -Werror";
    for (const fs::path& file : files)
        command += " '" + file.string() + "'";
    return treefarm::test::run_command(command);
}

bool have_clang_format() {
    return treefarm::test::run_command("clang-format --version").code == 0;
}

int count_lines(const fs::path& file) {
    std::ifstream source(file);
    int lines = 0;
    for (std::string text; std::getline(source, text);)
        ++lines;
    return lines;
}

TEST(Format, EverySourceIsFormatted) {
    if (!have_clang_format()) GTEST_SKIP() << "clang-format is not installed: run deploy/install";
    const auto files = formatted_sources();
    ASSERT_GT(files.size(), 20u) << "no sources below " << kRoot;
    const treefarm::test::Ended outcome = clang_format(files);
    EXPECT_EQ(outcome.code, 0) << "run clang-format -i on:\n" << outcome.output.substr(0, 4000);
}

TEST(Format, TheCheckSeesABadFile) {
    if (!have_clang_format()) GTEST_SKIP() << "clang-format is not installed: run deploy/install";
    // clang-format looks for .clang-format upwards from the file, so it gets a copy of ours.
    const fs::path folder = treefarm::test::test_folder();
    fs::copy_file(kRoot / ".clang-format", folder / ".clang-format", fs::copy_options::overwrite_existing);
    std::ofstream(folder / "bad.cpp") << "int  f( ){return 1 ;}\n";
    std::ofstream(folder / "good.cpp") << "int f() {\n    return 1;\n}\n";
    EXPECT_NE(clang_format({folder / "bad.cpp"}).code, 0);
    EXPECT_EQ(clang_format({folder / "good.cpp"}).code, 0);
}

TEST(Format, FilesStaySmall) {
    for (const fs::path& file : formatted_sources())
        EXPECT_LE(count_lines(file), kMostLines) << fs::relative(file, kRoot) << ": split it by concept";
}

}  // namespace
