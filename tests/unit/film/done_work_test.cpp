// SPDX-License-Identifier: Apache-2.0
#include "common/film/done_work.h"

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <tuple>

namespace treefarm {
namespace {

constexpr int kFilmWidth = 23, kHeight = 17;
constexpr std::uint32_t kChunks = 3;
constexpr std::uint64_t kLightPaths = 50'000;

using Atom = std::tuple<std::uint32_t, int, int>;  // chunk, x, y

std::vector<WorkUnit> all_units(int tile) {
    std::vector<WorkUnit> units = cut_tiles(2, kChunks, kFilmWidth, kHeight, tile);
    for (const WorkUnit& range : cut_range(2, UnitKind::light_paths, kLightPaths, 1000))
        units.push_back(range);
    return units;
}

/// Takes a unit's atoms out of these; a test fails where one is missing.
void take(std::multiset<Atom>& atoms, const WorkUnit& unit) {
    for (int y = unit.y0; y < unit.y1; ++y)
        for (int x = unit.x0; x < unit.x1; ++x) {
            const auto found = atoms.find({unit.chunk, x, y});
            ASSERT_NE(found, atoms.end()) << "twice: " << x << "," << y;
            atoms.erase(found);
        }
}

TEST(DoneWork, WhatIsLeftAndWhatIsDoneAreTheWholeHoweverItIsCut) {
    for (unsigned seed = 0; seed < 20; ++seed) {
        std::mt19937 engine(seed);
        DoneWork done(kFilmWidth, kHeight, kChunks);
        std::multiset<Atom> atoms;
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kFilmWidth; ++x)
                for (std::uint32_t c = 0; c < kChunks; ++c)
                    atoms.insert({c, x, y});
        std::uint64_t paths = 0, weight_done = 0;
        for (const WorkUnit& unit : all_units(8))
            for (const WorkUnit& piece : halve(unit)) {
                if (engine() % 100 >= 5 * seed) continue;
                done.add(piece);
                weight_done += weight(piece);
                if (piece.kind == UnitKind::tile)
                    take(atoms, piece);
                else
                    paths += piece.count;
            }
        EXPECT_EQ(done.weight(), weight_done);
        EXPECT_EQ(done.empty(), weight_done == 0);
        for (const WorkUnit& unit : all_units(10))
            for (const WorkUnit& left : done.left_of(unit)) {
                EXPECT_EQ(left.pass, 2u);
                if (left.kind == UnitKind::tile)
                    take(atoms, left);
                else
                    paths += left.count;
            }
        EXPECT_TRUE(atoms.empty());
        EXPECT_EQ(paths, kLightPaths);
        EXPECT_TRUE(done.fits(kFilmWidth * kHeight, kChunks, {0, kLightPaths, 0}));
        EXPECT_FALSE(done.fits(kFilmWidth * kHeight + 1, kChunks, {0, kLightPaths, 0}));
        EXPECT_FALSE(done.fits(kFilmWidth * kHeight, kChunks + 1, {0, kLightPaths, 0}));
        EXPECT_EQ(done.fits(kFilmWidth * kHeight, kChunks, {}), seed == 0) << "no ranges";
    }
}

TEST(DoneWork, AUnitThatIsNotBegunIsLeftAsItIsAndADoneOneNot) {
    DoneWork done(kFilmWidth, kHeight, kChunks);
    const WorkUnit tile{0, 3, 4, 11, 9, 1}, range{.kind = UnitKind::chains, .first = 5, .count = 2};
    EXPECT_EQ(done.left_of(tile), std::vector{tile});
    EXPECT_EQ(done.left_of(range), std::vector{range});
    done.add(tile);
    done.add(range);
    EXPECT_TRUE(done.left_of(tile).empty());
    EXPECT_TRUE(done.left_of(range).empty());
    EXPECT_FALSE(done.whole(4 * kFilmWidth + 3)) << "its other chunks are not";
    const WorkUnit other{0, 3, 4, 11, 9, 2};
    EXPECT_EQ(done.left_of(other), std::vector{other});
}

TEST(DoneWork, RangesThatTouchAreOne) {
    DoneWork done(1, 1, 1), at_once(1, 1, 1);
    for (const std::uint64_t first : {20u, 0u, 10u})
        done.add({.kind = UnitKind::light_paths, .first = first, .count = 10});
    at_once.add({.kind = UnitKind::light_paths, .first = 0, .count = 30});
    EXPECT_EQ(done, at_once);
}

}  // namespace
}  // namespace treefarm
