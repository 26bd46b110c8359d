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
    output.begin(work.guide());
    RecordLog& log = output.log.of<SdTreeGuide>();
    for (const Record& record : test::random_records(work.guide().regions(), 5000, 9)) {
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
        if (bundle == 0) first = result->evidence;
        EXPECT_EQ(result->evidence, first) << "bundle " << bundle;
        EXPECT_FALSE(work.close().has_value());
    }
    EXPECT_GT(first.size(), 5000u);
}

/// Splats travel with the units that made them, and take nothing where there are none.
TEST(PassWork, ABundleHoldsTheSplatsOfItsOwnUnits) {
    const SdTree tree = test::random_tree(3, 2000, 200, 1);
    PassPlan plan{.index = tree.pass, .spp = 1};
    plan.units = {.tiles = false, .light_paths = 1};
    plan.layers = {.estimates = false, .splats = {50, -4}};
    PassWork work(plan, tree, DirectionalFilter::box);
    SplatSums all(plan.layers.splats), bundles(plan.layers.splats);
    UnitOutput output;
    for (std::uint32_t unit = 0; unit < 20; ++unit) {
        output.begin(work.guide(), plan.layers.splats);
        for (std::uint32_t k = 0; k < (unit < 15 ? unit : 0); ++k)
            output.splats.add((unit * 7 + k) % 50, k, Rgb(static_cast<float>(k)), {1, 2, 3, 4});
        all.add(output.splats.summed(), output.splats.caps());
        work.deliver({.pass = plan.index, .kind = UnitKind::light_paths, .first = unit, .count = 1}, output);
        if (unit % 4 != 3) continue;
        const std::optional<Result> result = work.close();
        ASSERT_TRUE(result.has_value());
        EXPECT_EQ(result->units.size(), 4u);
        EXPECT_EQ(result->splats.empty(), unit > 15);
        if (!result->splats.empty()) bundles.merge_encoded(result->splats);
    }
    EXPECT_EQ(bundles, all);
}

}  // namespace
}  // namespace treefarm
