// SPDX-License-Identifier: Apache-2.0
// Pages that are generated stay true.
#include <gtest/gtest.h>

#include <fstream>
#include <regex>

#include "common/config/job_keys.h"
#include "common/plan/effects/effect_table.h"
#include "common/plan/resolve/policy_table.h"
#include "common/protocol/fingerprint.h"
#include "common/scene/kinds/kind_documentation.h"
#include "tests/support/test_folder.h"

namespace treefarm {
namespace {

std::string text_of(const std::string& name) {
    return test::read_file(std::string(TREEFARM_SOURCE_DIR) + "/" + name);
}

/// The parenthesised part of a pattern's first match; empty without one.
std::string first_match(const std::string& text, const std::string& pattern) {
    std::smatch match;
    return std::regex_search(text, match, std::regex(pattern)) ? match[1].str() : "";
}

/// The page of docs/generated holds a table that the program writes; if not, the table is left in a file.
void expect_page_holds(const std::string& name, const std::string& table) {
    const bool found = text_of("docs/generated/" + name).find(table) != std::string::npos;
    const fs::path file = treefarm::test::test_folder() / name;
    if (!found) std::ofstream(file) << table;
    EXPECT_TRUE(found) << "docs/generated/" << name << " is out of date; the table it should hold is in "
                       << file.string();
}

TEST(Docs, ListEveryJobKeyAsTheProgramKnowsIt) {
    expect_page_holds("jobs.md", job_key_documentation());
}

TEST(Docs, ListEveryEffectAsTheProgramKnowsIt) {
    expect_page_holds("effects.md", effect_documentation());
}

TEST(Docs, ListEveryTunedConstantAsTheProgramKnowsIt) {
    expect_page_holds("policy.md", policy_documentation());
}

TEST(Docs, ListEveryKindOfASceneAsTheProgramKnowsIt) {
    expect_page_holds("scene.md", kind_documentation());
}

TEST(Docs, SayTheVersionOfTheProgram) {
    const std::string version = R"((\d+\.\d+\.\d+))";
    EXPECT_EQ(first_match(text_of("CMakeLists.txt"), R"(project\(treefarm VERSION )" + version), kProgramVersion);
    EXPECT_EQ(first_match(text_of("CHANGELOG.md"), "\n## " + version), kProgramVersion);
    EXPECT_EQ(first_match(text_of("CITATION.cff"), "\nversion: " + version), kProgramVersion);
}

}  // namespace
}  // namespace treefarm
