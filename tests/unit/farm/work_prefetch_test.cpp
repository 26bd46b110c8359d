// SPDX-License-Identifier: Apache-2.0
#include "worker/work_prefetch.h"

#include <gtest/gtest.h>

namespace treefarm {
namespace {

constexpr int kTile = 32;

PassPlan prefetch_plan(std::uint32_t spp) {
    return {.spp = spp, .blocks_per_unit = 1, .chunks = 1};
}

TEST(Prefetch, IsForWhatKeepsTheThreadsBusyAndNoMore) {
    Prefetch prefetch(2);
    const auto first = prefetch.request(prefetch_plan(64), kTile, 0);
    ASSERT_TRUE(first);
    EXPECT_EQ(*first, 2u * 3u) << "units of 65536 paths";
    EXPECT_FALSE(prefetch.request(prefetch_plan(64), kTile, 0)) << "that is under way";
    prefetch.receive(*first, false);
    EXPECT_FALSE(prefetch.request(prefetch_plan(64), kTile, *first));
    const auto later = prefetch.request(prefetch_plan(64), kTile, *first - 2);
    ASSERT_TRUE(later);
    EXPECT_EQ(*later, 2u);
}

TEST(Prefetch, IsLargerForSmallUnits) {
    Prefetch small(2), large(2);
    EXPECT_GT(*small.request(prefetch_plan(1), kTile, 0), *large.request(prefetch_plan(64), kTile, 0));
}

TEST(Prefetch, OfOneWhoRunsDryIsToldOnceAgain) {
    Prefetch prefetch(4);
    const std::size_t depth = *prefetch.request(prefetch_plan(64), kTile, 0);
    prefetch.receive(3, false);  // of what it asked for: the rest is owed
    const auto hungry = prefetch.request(prefetch_plan(64), kTile, 3);
    ASSERT_TRUE(hungry);
    EXPECT_EQ(*hungry, 0u) << "it is owed " << depth - 3;
    EXPECT_FALSE(prefetch.request(prefetch_plan(64), kTile, 3));
    EXPECT_TRUE(prefetch.request(prefetch_plan(64), kTile, 2)) << "even less is left";
}

TEST(Prefetch, EndsWhereNothingIsLeft) {
    Prefetch prefetch(4);
    const std::size_t depth = *prefetch.request(prefetch_plan(64), kTile, 0);
    prefetch.receive(depth, false);
    EXPECT_TRUE(prefetch.is_well_stocked(prefetch_plan(64), kTile, 8));
    prefetch.receive(0, true);
    EXPECT_TRUE(prefetch.nothing_left());
    EXPECT_FALSE(prefetch.is_well_stocked(prefetch_plan(64), kTile, 8));
    prefetch.begin();
    EXPECT_FALSE(prefetch.nothing_left());
    EXPECT_EQ(*prefetch.request(prefetch_plan(64), kTile, 0), depth);
}

}  // namespace
}  // namespace treefarm
