// SPDX-License-Identifier: Apache-2.0
#include "coordinator/farm/ledger.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <random>
#include <set>

namespace treefarm {
namespace {

PassPlan plan(std::uint32_t chunks = 1) {
    return {.index = 4, .spp = 64 * chunks, .blocks_per_unit = 1, .chunks = chunks};
}

/// Some units, whole, or in pieces of so many paths.
Portion some(std::size_t units, std::uint64_t piece = ~std::uint64_t{0}) {
    return {units, ~std::uint64_t{0}, piece};
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
                const auto units = a.issue(1, some(3, 8192));
                EXPECT_EQ(units, b.issue(2, some(3, 8192)));
                EXPECT_TRUE(cover(marks, kWidth, kHeight, units));
                EXPECT_FALSE(a.complete());
                EXPECT_EQ(a.accept(1, units), Verdict::accepted);
            }
            EXPECT_TRUE(a.complete());
            EXPECT_EQ(a.done(), a.total());
            EXPECT_EQ(std::set<int>(marks.begin(), marks.end()), std::set<int>{1});
        }
}

TEST(Ledger, PiecesAreAsSmallAsIsAskedFor) {
    Ledger ledger(plan(), 256, 256, 32);
    EXPECT_EQ(ledger.waiting(), 64u);
    EXPECT_EQ(ledger.issue(1, some(1))[0].pixel_count(), 32u * 32u);
    EXPECT_EQ(ledger.issue(1, some(1, 65536))[0].pixel_count(), 32u * 32u);
    EXPECT_EQ(ledger.issue(1, some(1, 65535))[0].pixel_count(), 16u * 16u);
    EXPECT_EQ(ledger.waiting(), 61u + 3u);
}

TEST(Ledger, APortionHasNoMorePathsThanAreAskedForButOneUnit) {
    Ledger ledger(plan(), 256, 256, 32);
    const std::uint64_t whole = 32 * 32 * 64;
    EXPECT_EQ(ledger.issue(1, {100, 1, whole}).size(), 1u);
    EXPECT_EQ(ledger.issue(1, {100, 5 * whole - 1, whole}).size(), 4u);
    EXPECT_EQ(ledger.issue(1, {0, 5 * whole, whole}).size(), 0u);
    EXPECT_EQ(ledger.outstanding_paths(1), 5 * whole);
    EXPECT_EQ(ledger.waiting_paths(), 59 * whole);
}

TEST(Ledger, TinyPiecesAreNotCutFurther) {
    Ledger ledger(plan(), 7, 7, 32);
    EXPECT_EQ(ledger.issue(1, some(10, 1)).size(), 1u);
}

/// Pieces were cut down to 4 x 4 pixels whatever their samples: of a tenth of a millisecond each, they took a tenth of
/// a second to ask for.
TEST(Ledger, PiecesOfFewPathsAreNotCut) {
    for (const auto& [spp, smallest] : {std::pair{1u, 32u * 32u}, {8u, 16u * 16u}, {32u, 8u * 8u}, {64u, 8u * 8u}}) {
        Ledger ledger({.index = 0, .spp = spp}, 64, 64, 32);
        std::uint32_t least = 64 * 64;
        for (const WorkUnit& unit : ledger.issue(1, some(1000, 1)))
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
        for (const WorkUnit& unit : ledger.issue(1, some(1, ledger.waiting_paths() / 4))) {
            EXPECT_EQ(unit.kind, UnitKind::light_paths);
            EXPECT_EQ(unit.first, next);
            next += unit.count;
            most = std::max(most, unit.count);
            least = std::min(least, unit.count);
            EXPECT_EQ(ledger.accept(1, std::vector{unit}), Verdict::accepted);
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
    const std::vector<WorkUnit> units = ledger.issue(1, some(1000));
    EXPECT_EQ(units.front().kind, UnitKind::tile);
    EXPECT_EQ(units.back(), (WorkUnit{.pass = 4, .kind = UnitKind::chains, .first = 2, .count = 1}));
    const auto range =
        std::find_if(units.begin(), units.end(), [](const WorkUnit& u) { return u.kind == UnitKind::light_paths; });
    EXPECT_EQ(ledger.reclaim(1), units.size());
    EXPECT_EQ(ledger.issue(2, some(1000)).size(), units.size());
    EXPECT_EQ(ledger.judge(1, std::vector{*range}), Verdict::protocol_error) << "it was taken from worker 1";
    EXPECT_EQ(ledger.accept(2, units), Verdict::accepted);
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
    const auto mine = ledger.issue(1, some(1));
    const auto other = ledger.issue(2, some(1));
    EXPECT_EQ(ledger.accept(2, mine), Verdict::protocol_error);
    EXPECT_EQ(ledger.accept(1, std::vector{mine[0], other[0]}), Verdict::protocol_error)
        << "one of them is not worker 1's";
    EXPECT_EQ(ledger.accept(1, std::vector{mine[0], mine[0]}), Verdict::protocol_error) << "twice in one result";
    EXPECT_EQ(ledger.done(), 0u) << "a refused result must leave no trace";
    EXPECT_EQ(ledger.accept(1, mine), Verdict::accepted);
    EXPECT_EQ(ledger.accept(1, mine), Verdict::protocol_error) << "accepted twice";
    WorkUnit forged = other[0];
    forged.chunk = 9;
    EXPECT_EQ(ledger.accept(2, std::vector{forged}), Verdict::protocol_error);
    EXPECT_EQ(ledger.accept(2, other), Verdict::accepted);
    EXPECT_TRUE(ledger.complete());
}

TEST(Ledger, WorkOfALostWorkerIsIssuedAgainFirst) {
    Ledger ledger(plan(), 128, 32, 32);
    const auto lost = ledger.issue(1, some(2));
    const auto kept = ledger.issue(2, some(1));
    EXPECT_EQ(ledger.outstanding(1), 2u);
    EXPECT_EQ(ledger.reclaim(1), 2u);
    EXPECT_EQ(ledger.outstanding(1), 0u);
    EXPECT_EQ(ledger.accept(1, lost), Verdict::protocol_error) << "a late result of a lost worker counts nothing";
    EXPECT_EQ(ledger.issue(2, some(2)), lost);
    EXPECT_EQ(ledger.accept(2, lost), Verdict::accepted);
    EXPECT_EQ(ledger.accept(2, kept), Verdict::accepted);
    EXPECT_EQ(ledger.accept(3, ledger.issue(3, some(5))), Verdict::accepted);
    EXPECT_TRUE(ledger.complete());
}

/// Seconds that a copy would save: these, whoever has the unit, or where the worker `slow` has it.
std::function<double(int, const WorkUnit&)> saves(double seconds, int slow = -1) {
    return [=](int holder, const WorkUnit&) { return slow < 0 || holder == slow ? seconds : 0.0; };
}

TEST(Ledger, TheFirstOfTwoCopiesCounts) {
    Ledger ledger(plan(), 96, 32, 32);
    const auto slow = ledger.issue(1, some(2));
    EXPECT_TRUE(ledger.issue_copies(2, 5, saves(1)).empty()) << "something waits";
    const auto last = ledger.issue(2, some(1));
    EXPECT_TRUE(ledger.issue_copies(2, 5, saves(1)).empty()) << "it has work of its own";
    EXPECT_EQ(ledger.accept(2, last), Verdict::accepted);
    EXPECT_TRUE(ledger.issue_copies(2, 5, saves(0)).empty()) << "none is worth it";
    const auto copy = ledger.issue_copies(2, 1, saves(1));
    ASSERT_EQ(copy, std::vector{slow[1]}) << "what the other begins last";
    EXPECT_TRUE(ledger.issue_copies(3, 5, saves(1, 1)) == std::vector{slow[0]}) << "worker 2 is not slow";
    EXPECT_EQ(ledger.reclaim(3), 1u);
    EXPECT_EQ(ledger.outstanding(), 2u) << "worker 1 still has it";
    EXPECT_EQ(ledger.accept(2, copy), Verdict::accepted);
    EXPECT_EQ(ledger.take_superseded(1), copy);
    EXPECT_TRUE(ledger.take_superseded(1).empty()) << "told once";
    EXPECT_EQ(ledger.judge(1, slow), Verdict::late);
    EXPECT_EQ(ledger.accept(1, slow), Verdict::late);
    ledger.drop(1, slow);
    EXPECT_EQ(ledger.judge(1, copy), Verdict::protocol_error) << "late but once";
    EXPECT_EQ(ledger.issue(2, some(5)), std::vector{slow[0]}) << "what else was in a late result is issued again";
    EXPECT_EQ(ledger.accept(2, std::vector{slow[0]}), Verdict::accepted);
    EXPECT_TRUE(ledger.complete());
}

TEST(Ledger, AUnitOfWhichAllCopiesAreOverdueIsCopiedOnceMore) {
    Ledger ledger(plan(), 64, 32, 32);
    const auto unit = ledger.issue(1, some(1)), other = ledger.issue(2, some(1));
    EXPECT_TRUE(ledger.issue_copies(2, 5, saves(1)).empty()) << "it has work of its own";
    EXPECT_EQ(ledger.issue_copies(2, 5, saves(1), true), unit) << "its own unit is stuck";
    EXPECT_EQ(ledger.issue_copies(1, 5, saves(1), true), other);
    EXPECT_TRUE(ledger.issue_copies(1, 5, saves(1), true).empty()) << "one copy a worker";
    EXPECT_EQ(ledger.issue_copies(3, 5, saves(1)).size(), 2u);
    EXPECT_EQ(ledger.accept(3, unit), Verdict::accepted);
    EXPECT_EQ(ledger.take_superseded(1), unit);
    EXPECT_EQ(ledger.take_superseded(2), unit);
    EXPECT_EQ(ledger.judge(2, unit), Verdict::late);
    EXPECT_EQ(ledger.reclaim(3), 1u);
    EXPECT_EQ(ledger.waiting(), 0u) << "two still have it";
    EXPECT_EQ(ledger.accept(1, other), Verdict::accepted);
    EXPECT_TRUE(ledger.complete());
    EXPECT_EQ(ledger.outstanding_paths(1) + ledger.outstanding_paths(2) + ledger.outstanding_paths(3), 0u);
}

TEST(Ledger, ASuspectMayBeCopiedAndWaitsForNobodyWhoIsStuck) {
    Ledger ledger(plan(), 96, 32, 32);
    const auto stuck = ledger.issue(1, some(1)), lost = ledger.issue(2, some(1)), rest = ledger.issue(3, some(1));
    ledger.reclaim(2, true);
    EXPECT_TRUE(ledger.is_suspect(lost[0]));
    EXPECT_TRUE(ledger.issue(1, some(1)).empty());
    EXPECT_EQ(ledger.issue(1, some(1), true), lost) << "the worker is idle, though its own unit is stuck";
    EXPECT_EQ(ledger.accept(3, rest), Verdict::accepted);
    EXPECT_EQ(ledger.issue_copies(3, 5, saves(1)).size(), 2u);
    EXPECT_EQ(ledger.accept(3, lost), Verdict::accepted);
    EXPECT_EQ(ledger.accept(3, stuck), Verdict::accepted);
    EXPECT_TRUE(ledger.complete());
}

TEST(Ledger, AUnitThatWorkersAreLostOverIsIssuedAlone) {
    Ledger ledger(plan(), 128, 32, 32);
    const auto lost = ledger.issue(1, some(2));
    const auto kept = ledger.issue(2, some(1));
    EXPECT_EQ(ledger.reclaim(1, true), 2u);
    EXPECT_EQ(ledger.waiting(), 1u);
    EXPECT_EQ(ledger.suspects(), 2u);
    const auto others = ledger.issue(2, some(5));
    EXPECT_EQ(others.size(), 1u) << "worker 2 has something: no suspect for it";
    EXPECT_EQ(ledger.issue(3, some(5)), std::vector{lost[0]});
    EXPECT_TRUE(ledger.has_suspect(3));
    EXPECT_TRUE(ledger.issue(3, some(5)).empty()) << "alone";
    EXPECT_EQ(ledger.accept(2, kept), Verdict::accepted);
    EXPECT_EQ(ledger.accept(2, others), Verdict::accepted);
    EXPECT_EQ(ledger.issue(2, some(5)), std::vector{lost[1]});
    EXPECT_EQ(ledger.accept(2, std::vector{lost[1]}), Verdict::accepted) << "it was not the one";
    EXPECT_EQ(ledger.reclaim(3, true), 1u);
    EXPECT_EQ(ledger.worst_poison_unit(), (std::pair<WorkUnit, std::size_t>(lost[0], 2)));
    ledger.forgive(3);
    EXPECT_EQ(ledger.worst_poison_unit().second, 1u) << "worker 3 is back: it was silent, not dead";
    EXPECT_EQ(ledger.issue(2, some(5)), std::vector{lost[0]});
    EXPECT_EQ(ledger.reclaim(2, true), 1u);
    EXPECT_EQ(ledger.issue(4, some(5)), std::vector{lost[0]});
    EXPECT_EQ(ledger.reclaim(4, true), 1u);
    EXPECT_EQ(ledger.worst_poison_unit().second, Ledger::kMostDeaths);
}

/// Whatever is issued, copied, delivered, late, lost and lied about: every atom is done once, and nothing is forgotten.
TEST(Ledger, EveryAtomIsDoneOnceWhateverHappens) {
    for (unsigned seed = 0; seed < 60; ++seed) {
        std::mt19937 engine(seed);
        const auto below = [&](std::size_t n) { return static_cast<std::size_t>(engine() % n); };
        constexpr int kWidth = 96, kHeight = 64, kWorkers = 5;
        Ledger ledger(plan(2), kWidth, kHeight, 16);
        std::vector<int> marks(kWidth * kHeight * 2, 0);
        std::vector<std::vector<WorkUnit>> bags(kWorkers);
        for (int step = 0; step < 20'000 && !ledger.complete(); ++step) {
            const auto worker = static_cast<int>(below(kWorkers));
            std::vector<WorkUnit>& bag = bags[static_cast<std::size_t>(worker)];
            const std::size_t what = below(20);
            if (what < 8) {
                const auto units = ledger.issue(worker, {1 + below(4), 1 + engine() % 100'000, 1 + engine() % 30'000});
                bag.insert(bag.end(), units.begin(), units.end());
            } else if (what < 11) {
                const auto units = ledger.issue_copies(worker, 1 + below(3), saves(static_cast<double>(below(2))));
                bag.insert(bag.end(), units.begin(), units.end());
            } else if (what < 18 && !bag.empty()) {
                std::shuffle(bag.begin(), bag.end(), engine);
                const std::vector<WorkUnit> sent(bag.end() - std::ptrdiff_t(1 + below(bag.size())), bag.end());
                bag.resize(bag.size() - sent.size());
                const Verdict verdict = ledger.accept(worker, sent);
                ASSERT_NE(verdict, Verdict::protocol_error) << "seed " << seed;
                if (verdict == Verdict::accepted) {
                    ASSERT_TRUE(cover(marks, kWidth, kHeight, sent)) << "seed " << seed;
                } else {
                    ledger.drop(worker, sent);
                }
            } else if (what == 18) {
                for (const WorkUnit& unit : ledger.take_superseded(worker))
                    std::erase(bag, unit);
            } else if (what == 19 && below(10) == 0) {
                ledger.reclaim(worker, below(2) == 0);
                bag.clear();
                if (below(2) == 0) ledger.forgive(worker);
            }
            std::uint64_t held = 0;
            for (int w = 0; w < kWorkers; ++w)
                held += ledger.outstanding_paths(w);
            ASSERT_LE(ledger.waiting_paths() + ledger.done() * 64, ledger.total() * 64) << "seed " << seed;
            ASSERT_GE(ledger.waiting_paths() + ledger.done() * 64 + held + ledger.suspects() * 65'536,
                      ledger.total() * 64)
                << "seed " << seed << ": something was forgotten";
        }
        ASSERT_TRUE(ledger.complete()) << "seed " << seed;
        EXPECT_EQ(std::set<int>(marks.begin(), marks.end()), std::set<int>{1}) << "seed " << seed;
    }
}

TEST(Ledger, WhatAnEarlierLifeDidIsNotIssuedAndPoisonUnitsAlone) {
    constexpr int kWidth = 61, kHeight = 47;
    Ledger before(plan(2), kWidth, kHeight, 16);
    DoneWork done(kWidth, kHeight, 2);
    std::vector<int> marks(kWidth * kHeight * 2, 0);
    for (int k = 0; k < 5; ++k) {
        const auto units = before.issue(1, some(2, 8192));
        for (const WorkUnit& unit : units)
            done.add(unit);
        cover(marks, kWidth, kHeight, units);
        before.accept(1, units);
    }
    const std::vector<WorkUnit> poison = before.issue(2, some(1));
    before.reclaim(2, true);
    before.issue(3, some(1));
    before.reclaim(3, true);
    ASSERT_EQ(before.poison_units(), (std::vector<PoisonUnit>{{poison[0], 2}}));

    Ledger after(plan(2), kWidth, kHeight, 9, done, before.poison_units());
    EXPECT_EQ(after.done(), before.done());
    EXPECT_EQ(after.total(), before.total());
    EXPECT_EQ(after.poison_units(), before.poison_units());
    after.forgive(1);  // workers of this life have nothing to do with it
    const std::vector<WorkUnit> first = after.issue(1, some(4));
    EXPECT_EQ(first, poison);
    EXPECT_TRUE(after.has_suspect(1));
    EXPECT_TRUE(cover(marks, kWidth, kHeight, first));
    while (after.waiting() > 0) {
        const auto units = after.issue(2, some(3));
        EXPECT_TRUE(cover(marks, kWidth, kHeight, units));
        EXPECT_EQ(after.accept(2, units), Verdict::accepted);
    }
    EXPECT_EQ(after.waiting_paths(), 0u);
    EXPECT_EQ(after.done() + poison[0].pixel_count(), after.total());
    EXPECT_FALSE(after.complete());
    after.reclaim(1, true);
    EXPECT_EQ(after.worst_poison_unit().second, 3u) << "the third death, of all lives";
    EXPECT_EQ(after.poison_units()[0].deaths, 2u) << "the next life gives it one more try";
    EXPECT_EQ(after.accept(3, after.issue(3, some(1))), Verdict::accepted);
    EXPECT_TRUE(after.complete());
    EXPECT_EQ(std::set<int>(marks.begin(), marks.end()), std::set<int>{1});
}

}  // namespace
}  // namespace treefarm
