// SPDX-License-Identifier: Apache-2.0
// Our functions against 113-bit arithmetic: a smaller run of what docs/generated/hard-cases.md tables (tests/oracle).
#include <gtest/gtest.h>

#ifdef TREEFARM_HAS_QUAD
#include "tests/oracle/oracle.h"

namespace treefarm {
namespace {

TEST(Oracles, KeepTheirBounds) {
    const std::vector<oracle::Row> rows = oracle::all(20'000);
    EXPECT_GE(rows.size(), 20u);
    for (const oracle::Row& row : rows) {
        EXPECT_GT(row.inputs, 0u) << row.what;
        EXPECT_LE(row.worst, row.bound) << row.what << ": " << row.worst_input;
    }
}

}  // namespace
}  // namespace treefarm
#else
TEST(Oracles, NeedQuadruplePrecision) {
    GTEST_SKIP() << "quadmath.h comes with g++";
}
#endif
