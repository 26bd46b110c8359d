// SPDX-License-Identifier: Apache-2.0
#include "worker/pass_work.h"

#include <gtest/gtest.h>

#include "tests/support/random_tree.h"

namespace treefarm {
namespace {

/// Sums are used again from bundle to bundle: nothing of one may be left in the next.
TEST(PassWork, ABundleHoldsWhatItsOwnUnitsTaught) {
    const SdTree tree = test::random_tree(3, 20000, 2000, 1);
    PassWork work({.index = tree.pass, .spp = 1, .record = true, .learn_mixture = true}, tree, DirectionalFilter::box);
    UnitOutput output;
    output.begin(work.guide().distribution_count());
    RecordLog& log = output.log;
    for (const Record& record : test::random_records(work.guide(), 5000, 9)) {
        log.records.push_back(record);
        ++log.counts[record.distribution];
    }
    log.caps.capped_records = 2;
    const WorkUnit unit{.pass = tree.pass, .x1 = 1, .y1 = 1};
    EXPECT_FALSE(work.close().has_value());
    Bytes first;
    for (int bundle = 0; bundle < 4; ++bundle) {
        output.pixels.resize(1);
        work.deliver(unit, output);
        const std::optional<Result> result = work.close();
        ASSERT_TRUE(result.has_value());
        EXPECT_EQ(result->units.size(), 1u);
        if (bundle == 0) first = result->update;
        EXPECT_EQ(result->update, first) << "bundle " << bundle;
        EXPECT_FALSE(work.close().has_value());
    }
    EXPECT_GT(first.size(), 5000u);
}

}  // namespace
}  // namespace treefarm
