// SPDX-License-Identifier: Apache-2.0
#include "worker/appetite.h"

#include <gtest/gtest.h>

namespace treefarm {
namespace {

constexpr int kTile = 32;

PassPlan plan(std::uint32_t spp) {
    return {.spp = spp, .blocks_per_unit = 1, .chunks = 1};
}

TEST(Appetite, IsForWhatKeepsTheThreadsBusyAndNoMore) {
    Appetite appetite(2);
    const auto first = appetite.ask(plan(64), kTile, 0);
    ASSERT_TRUE(first);
    EXPECT_EQ(*first, 2u * 3u) << "units of 65536 paths";
    EXPECT_FALSE(appetite.ask(plan(64), kTile, 0)) << "that is under way";
    appetite.receive(*first, false);
    EXPECT_FALSE(appetite.ask(plan(64), kTile, *first));
    const auto later = appetite.ask(plan(64), kTile, *first - 2);
    ASSERT_TRUE(later);
    EXPECT_EQ(*later, 2u);
}

TEST(Appetite, IsLargerForSmallUnits) {
    Appetite small(2), large(2);
    EXPECT_GT(*small.ask(plan(1), kTile, 0), *large.ask(plan(64), kTile, 0));
}

TEST(Appetite, OfOneWhoRunsDryIsToldOnceAgain) {
    Appetite appetite(4);
    const std::size_t depth = *appetite.ask(plan(64), kTile, 0);
    appetite.receive(3, false);  // of what it asked for: the rest is owed
    const auto hungry = appetite.ask(plan(64), kTile, 3);
    ASSERT_TRUE(hungry);
    EXPECT_EQ(*hungry, 0u) << "it is owed " << depth - 3;
    EXPECT_FALSE(appetite.ask(plan(64), kTile, 3));
    EXPECT_TRUE(appetite.ask(plan(64), kTile, 2)) << "even less is left";
}

TEST(Appetite, EndsWhereNothingIsLeft) {
    Appetite appetite(4);
    const std::size_t depth = *appetite.ask(plan(64), kTile, 0);
    appetite.receive(depth, false);
    EXPECT_TRUE(appetite.is_well_stocked(plan(64), kTile, 8));
    appetite.receive(0, true);
    EXPECT_TRUE(appetite.nothing_left());
    EXPECT_FALSE(appetite.is_well_stocked(plan(64), kTile, 8));
    appetite.begin();
    EXPECT_FALSE(appetite.nothing_left());
    EXPECT_EQ(*appetite.ask(plan(64), kTile, 0), depth);
}

}  // namespace
}  // namespace treefarm
