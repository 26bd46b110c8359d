// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cctype>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "tests/support/source_root.h"

namespace {

namespace fs = std::filesystem;

/// Whether C++ code names `word`, outside of comments at the end of its lines.
bool names(std::istream& source, const std::string& word) {
    const auto in_word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
    for (std::string line; std::getline(source, line);) {
        const std::string code = " " + line.substr(0, line.find("//")) + " ";
        for (std::size_t at = code.find(word); at != std::string::npos; at = code.find(word, at + 1))
            if (!in_word(code[at - 1]) && !in_word(code[at + word.size()])) return true;
    }
    return false;
}

bool line_names_job(const std::string& line) {
    std::istringstream source(line);
    return names(source, "Job");
}

TEST(ResolvedJob, AJobIsFoundInCodeAndNotInComments) {
    EXPECT_TRUE(line_names_job("RenderUnit make(Scene scene, const Job& job);"));
    EXPECT_TRUE(line_names_job("explicit Rules(const Job::Integrator&);  // from the job"));
    EXPECT_FALSE(line_names_job("struct TileJob { const Resolved& job; };"));
    EXPECT_FALSE(line_names_job("int isa;  ///< as in Job::Farm"));
}

/// A setting that may be "auto" is never seen while a worker prepares or traces a scene.
TEST(ResolvedJob, AWorkerNamesJobsOnlyWhereTheyAreReceivedAndResolved) {
    std::size_t files = 0;
    for (const auto& entry : fs::recursive_directory_iterator(treefarm::test::kRoot / "worker")) {
        const fs::path extension = entry.path().extension();
        if (extension != ".h" && extension != ".cpp") continue;
        ++files;
        std::ifstream source(entry.path());
        const bool receives = fs::relative(entry.path(), treefarm::test::kRoot) == "worker/worker_loop.cpp";
        EXPECT_EQ(names(source, "Job"), receives) << entry.path() << ": takes a Resolved (common/plan/resolve)";
    }
    EXPECT_GT(files, 100u);
}

}  // namespace
