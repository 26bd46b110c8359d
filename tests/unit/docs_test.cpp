// Pages that are generated stay true.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "common/config/job_keys.h"

namespace treefarm {
namespace {

TEST(Docs, ListEveryJobKeyAsTheProgramKnowsIt) {
    std::ifstream page(std::string(TREEFARM_SOURCE_DIR) + "/docs/jobs.md");
    std::ostringstream text;
    text << page.rdbuf();
    const std::string expected = job_key_documentation();
    const bool found = text.str().find(expected) != std::string::npos;
    if (!found) std::ofstream(::testing::TempDir() + "jobs.md") << expected;
    EXPECT_TRUE(found) << "docs/jobs.md is out of date; the table it should hold is in " << ::testing::TempDir()
                       << "jobs.md";
}

}  // namespace
}  // namespace treefarm
