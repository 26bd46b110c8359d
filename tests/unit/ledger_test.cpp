// SPDX-License-Identifier: Apache-2.0
#include "coordinator/ledger.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace treefarm {
namespace {

PassPlan plan(std::uint32_t chunks = 1) {
    return {.index = 4, .spp = 64 * chunks, .blocks_per_unit = 1, .chunks = chunks};
}

/// Marks the units' pixels; false if one of them was marked before.
bool cover(std::vector<int>& marks, int width, int height, const std::vector<WorkUnit>& units) {
    bool fresh = true;
    for (const WorkUnit& unit : units)
        for (int y = unit.y0; y < unit.y1; ++y)
            for (int x = unit.x0; x < unit.x1; ++x) {
                const auto at = static_cast<std::size_t>((static_cast<int>(unit.chunk) * height + y) * width + x);
                fresh &= ++marks[at] == 1;
            }
    return fresh;
}

TEST(Ledger, IssuesEveryAtomOnceInAFixedOrder) {
    for (const int tile : {8, 32, 50})
        for (const std::uint32_t chunks : {1u, 3u}) {
            constexpr int kWidth = 101, kHeight = 37;
            Ledger a(plan(chunks), kWidth, kHeight, tile), b(plan(chunks), kWidth, kHeight, tile);
            std::vector<int> marks(kWidth * kHeight * chunks, 0);
            while (a.waiting() > 0) {
                const auto units = a.issue(1, 3, 20);
                EXPECT_EQ(units, b.issue(2, 3, 20));
                EXPECT_TRUE(cover(marks, kWidth, kHeight, units));
                EXPECT_FALSE(a.complete());
                EXPECT_TRUE(a.accept(1, units));
            }
            EXPECT_TRUE(a.complete());
            EXPECT_EQ(a.done(), a.total());
            EXPECT_EQ(std::set<int>(marks.begin(), marks.end()), std::set<int>{1});
        }
}

TEST(Ledger, PiecesShrinkTowardsTheEnd) {
    Ledger ledger(plan(), 256, 256, 32);
    EXPECT_EQ(ledger.waiting(), 64u);
    EXPECT_EQ(ledger.issue(1, 1, 10)[0].pixel_count(), 32u * 32u);
    ledger.issue(1, 54, 10);
    EXPECT_EQ(ledger.issue(1, 1, 10)[0].pixel_count(), 16u * 16u);
}

TEST(Ledger, TinyPiecesAreNotCutFurther) {
    Ledger ledger(plan(), 7, 7, 32);
    EXPECT_EQ(ledger.issue(1, 10, 100).size(), 1u);
}

/// Pieces were cut down to 4 x 4 pixels whatever their samples: of a tenth of a millisecond each, they took a tenth of
/// a second to ask for.
TEST(Ledger, PiecesOfFewPathsAreNotCut) {
    for (const auto& [spp, smallest] : {std::pair{1u, 32u * 32u}, {8u, 16u * 16u}, {32u, 8u * 8u}, {64u, 8u * 8u}}) {
        Ledger ledger({.index = 0, .spp = spp}, 64, 64, 32);
        std::uint32_t least = 64 * 64;
        for (const WorkUnit& unit : ledger.issue(1, 1000, 1000))
            least = std::min(least, unit.pixel_count());
        EXPECT_EQ(least, smallest) << spp << " spp";
    }
}

PassPlan light_plan(std::uint32_t paths) {
    PassPlan plan{.index = 4, .spp = 1};
    plan.units = {.tiles = false, .light_paths = paths};
    plan.layers = {.estimates = false, .splats = {101 * 37, 0}};
    return plan;
}

TEST(Ledger, RangesCoverEveryPathOnceAndShrink) {
    constexpr std::uint64_t kPaths = 101 * 37 * 50;
    Ledger ledger(light_plan(50), 101, 37, 32);
    EXPECT_EQ(ledger.total(), kPaths);
    std::uint64_t next = 0;
    std::uint32_t most = 0, least = kRangePaths;
    while (ledger.waiting() > 0)
        for (const WorkUnit& unit : ledger.issue(1, 1, 6)) {
            EXPECT_EQ(unit.kind, UnitKind::light_paths);
            EXPECT_EQ(unit.first, next);
            next += unit.count;
            most = std::max(most, unit.count);
            least = std::min(least, unit.count);
            EXPECT_TRUE(ledger.accept(1, std::vector{unit}));
            EXPECT_EQ(ledger.done(), next);
        }
    EXPECT_EQ(next, kPaths);
    EXPECT_TRUE(ledger.complete());
    EXPECT_EQ(most, kRangePaths);
    EXPECT_LT(least, kRangePaths / 2);
    EXPECT_GE(least, 2048u / 2) << "but for the rest at the end, which nobody cut";
}

TEST(Ledger, APassMayHaveUnitsOfSeveralKinds) {
    PassPlan plan = light_plan(2);
    plan.units.tiles = plan.layers.estimates = true;
    plan.units.chains = 3;
    Ledger ledger(plan, 101, 37, 32);
    EXPECT_EQ(ledger.total(), 3u * 101 * 37 + 3);
    const std::vector<WorkUnit> units = ledger.issue(1, 1000, 0);
    EXPECT_EQ(units.front().kind, UnitKind::tile);
    EXPECT_EQ(units.back(), (WorkUnit{.pass = 4, .kind = UnitKind::chains, .first = 2, .count = 1}));
    const auto range =
        std::find_if(units.begin(), units.end(), [](const WorkUnit& u) { return u.kind == UnitKind::light_paths; });
    EXPECT_EQ(ledger.reclaim(1), units.size());
    EXPECT_EQ(ledger.issue(2, 1000, 0).size(), units.size());
    EXPECT_FALSE(ledger.holds(1, std::vector{*range})) << "it was taken from worker 1";
    EXPECT_TRUE(ledger.accept(2, units));
    EXPECT_TRUE(ledger.complete());
}

TEST(WorkUnit, PiecesCoverTheWhole) {
    const WorkUnit range{.kind = UnitKind::light_paths, .first = 5, .count = 7};
    const auto halves = halve(range);
    ASSERT_EQ(halves.size(), 2u);
    EXPECT_EQ(halves[0].first, 5u);
    EXPECT_EQ(halves[1].first, 5u + halves[0].count);
    EXPECT_EQ(halves[0].count + halves[1].count, 7u);
    const WorkUnit chain{.kind = UnitKind::chains, .first = 5, .count = 1};
    EXPECT_EQ(halve(chain), std::vector{chain});
    std::uint64_t pixels = 0;
    for (const WorkUnit& piece : halve({0, 1, 1, 8, 4, 2}))
        pixels += weight(piece);
    EXPECT_EQ(pixels, weight({0, 1, 1, 8, 4, 2}));
}

TEST(Ledger, AcceptsOnlyWhatTheWorkerHasAndOnlyOnce) {
    Ledger ledger(plan(), 64, 32, 32);
    const auto mine = ledger.issue(1, 1, 0);
    const auto other = ledger.issue(2, 1, 0);
    EXPECT_FALSE(ledger.accept(2, mine));
    EXPECT_FALSE(ledger.accept(1, std::vector{mine[0], other[0]})) << "one of them is not worker 1's";
    EXPECT_FALSE(ledger.accept(1, std::vector{mine[0], mine[0]})) << "twice in one result";
    EXPECT_EQ(ledger.done(), 0u) << "a refused result must leave no trace";
    EXPECT_TRUE(ledger.accept(1, mine));
    EXPECT_FALSE(ledger.accept(1, mine)) << "accepted twice";
    WorkUnit forged = other[0];
    forged.chunk = 9;
    EXPECT_FALSE(ledger.accept(2, std::vector{forged}));
    EXPECT_TRUE(ledger.accept(2, other));
    EXPECT_TRUE(ledger.complete());
}

TEST(Ledger, WorkOfALostWorkerIsIssuedAgainFirst) {
    Ledger ledger(plan(), 128, 32, 32);
    const auto lost = ledger.issue(1, 2, 0);
    const auto kept = ledger.issue(2, 1, 0);
    EXPECT_EQ(ledger.outstanding(1), 2u);
    EXPECT_EQ(ledger.reclaim(1), 2u);
    EXPECT_EQ(ledger.outstanding(1), 0u);
    EXPECT_FALSE(ledger.accept(1, lost)) << "a late result of a lost worker counts nothing";
    EXPECT_EQ(ledger.issue(2, 2, 0), lost);
    EXPECT_TRUE(ledger.accept(2, lost));
    EXPECT_TRUE(ledger.accept(2, kept));
    EXPECT_TRUE(ledger.accept(3, ledger.issue(3, 5, 0)));
    EXPECT_TRUE(ledger.complete());
}

}  // namespace
}  // namespace treefarm
