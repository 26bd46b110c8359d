// SPDX-License-Identifier: Apache-2.0
// A decision of its own, added to those of the program by one line: CONTRIBUTING, "A decision".
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <set>
#include <string>
#include <variant>

#include "common/decide/decisions.h"
#include "common/evidence/evidence.h"
#include "common/protocol/archive.h"

// Parts of others contain arrays.
#include <cereal/types/array.hpp>

namespace treefarm {
namespace {

/// Passes sample emitters directly once two of them found light along fewer than one path in a hundred.
struct DarkDecision {
    /// What paths that light found add up to.
    struct Evidence {
        std::uint64_t paths = 0, found = 0;

        static constexpr BlockShape kBlock{"dark", "paths", BlockKind::sums, 1, 2};
        template <class Sums, class Visit>
        static constexpr void each(Sums& sums, Visit visit) {
            visit(sums.paths);
            visit(sums.found);
        }
        void add(const Evidence& other) {
            paths += other.paths;
            found += other.found;
        }
    };

    struct Memory {
        std::uint32_t dark_passes = 0;

        template <class Archive>
        void serialize(Archive& archive) {
            archive(dark_passes);
        }
    };

    struct Figures {
        double found = 0;  ///< share of paths

        template <class Archive>
        void serialize(Archive& archive) {
            archive(found);
        }
    };

    static constexpr bool kScheduled = true;
    static void judge(const JudgedPass&, const Evidence& sums, Memory& memory, Figures& figures) {
        figures.found = static_cast<double>(sums.found) / static_cast<double>(sums.paths);
        if (figures.found < 0.01) ++memory.dark_passes;
    }
    static void apply(PassPlan& plan, const Memory& memory) {
        if (memory.dark_passes >= 2) plan.next_event = true;
    }

    static constexpr DecisionColumn<Figures> kColumns[] = {
        {{"found_share", "fraction", kAll, "paths that found light"},
         [](const PassPlan&, const Figures& f) -> FigureValue { return f.found; }},
    };
};

template <class... D>
DecisionList<D..., DarkDecision> with_toy(DecisionList<D...>);
using Extended = decltype(with_toy(Decisions()));

/// Judges a pass of 1000 paths, of which so many found light, and returns the figures.
Extended::Figures judge(Extended::Memories& memories, std::uint64_t found) {
    const PassPlan plan;
    const TraceCounts counts;
    Blocks received = Extended::blocks();
    for (const std::uint64_t part : {found / 3, found - found / 3}) {  // of two work units
        Extended::Evidence sums;
        sums.get<DarkDecision::Evidence>() = {500, part};
        Blocks sent = Extended::blocks();
        Extended::put(sums, sent);
        const Blocks* const owners[] = {&sent};
        Blocks* const collected[] = {&received};
        merge_evidence(0, collected, encode_evidence(0, owners));
    }
    Extended::Figures figures;
    Extended::judge({.plan = plan, .counts = counts}, Extended::evidence(received), memories, figures);
    return figures;
}

bool samples_emitters(const Extended::Memories& memories, bool scheduled = true) {
    PassPlan plan;
    Extended::apply(plan, memories, scheduled);
    return plan.next_event;
}

TEST(ToyDecision, ChangesThePlanByWhatPassesCounted) {
    Extended::Memories memories;
    judge(memories, 5);
    judge(memories, 500);
    EXPECT_FALSE(samples_emitters(memories));
    judge(memories, 9);
    EXPECT_TRUE(samples_emitters(memories));
    EXPECT_FALSE(samples_emitters(memories, false)) << "a schedule has it";
}

/// Decision that reports what the next pass does by decisions before it.
struct FollowingDecision : DarkDecision {
    struct Evidence : DarkDecision::Evidence {};
    struct Memory : DarkDecision::Memory {};
    struct Figures : DarkDecision::Figures {};

    static void judge(const JudgedPass& pass, const Evidence&, Memory&, Figures& figures) {
        figures.found = pass.next.next_event ? 1 : 0;
    }
    static void apply(PassPlan&, const Memory&) {}

    static constexpr DecisionColumn<Figures> kColumns[] = {
        {{"followed", "0 or 1", kAll, "the next pass samples emitters"},
         [](const PassPlan&, const Figures& f) -> FigureValue { return f.found; }},
    };
};

TEST(ToyDecision, IsSeenByThoseAfterIt) {
    using Two = DecisionList<DarkDecision, FollowingDecision>;
    Two::Memories memories;
    const PassPlan plan;
    const TraceCounts counts;
    Two::Evidence sums;
    sums.get<DarkDecision::Evidence>() = {1000, 0};
    for (const double follows : {0, 1}) {
        Two::Figures figures;
        Two::judge({.plan = plan, .counts = counts}, sums, memories, figures);
        EXPECT_EQ(figures.get<FollowingDecision::Figures>().found, follows);
    }
}

TEST(ToyDecision, IsKeptByACheckpointWithTheOthers) {
    Extended::Memories memories, back;
    const Extended::Figures reported = judge(memories, 5);
    memories.get<SplittingDecision::Memory>().pays = false;
    ByteWriter writer;
    WriteArchive written(writer);
    written(memories, reported);
    const Bytes bytes = writer.take();
    ByteReader reader(bytes);
    ReadArchive read(reader);
    Extended::Figures figures;
    read(back, figures);
    reader.expect_end();
    EXPECT_FALSE(back.get<SplittingDecision::Memory>().pays);
    EXPECT_EQ(figures.get<DarkDecision::Figures>().found, 0.005);
    EXPECT_FALSE(samples_emitters(back));
    judge(back, 0);
    EXPECT_TRUE(samples_emitters(back));
}

TEST(ToyDecision, HasAColumnAfterThoseOfTheOthers) {
    Extended::Memories memories;
    const std::vector<FigureValue> values = Extended::values({}, judge(memories, 250));
    ASSERT_EQ(values.size(), Extended::kFigures.size());
    EXPECT_EQ(values.size(), Decisions::kFigures.size() + 1);
    EXPECT_EQ(Extended::kFigures.back().name, std::string("found_share"));
    EXPECT_EQ(std::get<double>(values.back()), 0.25);
    std::set<std::string> names;
    for (const PassFigure& figure : Extended::kFigures)
        EXPECT_TRUE(names.insert(figure.name).second) << figure.name;
}

}  // namespace
}  // namespace treefarm
