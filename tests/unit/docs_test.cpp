// Pages that are generated stay true.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "common/config/job_keys.h"
#include "common/plan/effect_table.h"

namespace treefarm {
namespace {

/// The page of docs/ holds a table that the program writes; if not, the table is left in a file.
void expect_page_holds(const std::string& name, const std::string& table) {
    std::ifstream page(std::string(TREEFARM_SOURCE_DIR) + "/docs/generated/" + name);
    std::ostringstream text;
    text << page.rdbuf();
    const bool found = text.str().find(table) != std::string::npos;
    if (!found) std::ofstream(::testing::TempDir() + name) << table;
    EXPECT_TRUE(found) << "docs/generated/" << name << " is out of date; the table it should hold is in "
                       << ::testing::TempDir() << name;
}

TEST(Docs, ListEveryJobKeyAsTheProgramKnowsIt) {
    expect_page_holds("jobs.md", job_key_documentation());
}

TEST(Docs, ListEveryEffectAsTheProgramKnowsIt) {
    expect_page_holds("effects.md", effect_documentation());
}

}  // namespace
}  // namespace treefarm
