// SPDX-License-Identifier: Apache-2.0
// Workers that are slow, stand still, or die over a unit, in one process.
#include "tests/fault/farm_fixture.h"

namespace treefarm::test {
namespace {

/// The fake renderer, but `before(unit)` comes first.
template <class Before>
MakeRenderer make_hindered(Before before) {
    return [before](const Scene&, const Resolved& job) -> RenderUnit {
        return [before, render = fake_renderer(job)](const PassPlan& pass, const AnySampler& guide,
                                                     const WorkUnit& unit, UnitOutput& output) {
            before(unit);
            render(pass, guide, unit, output);
        };
    };
}

void nap(int milliseconds) {
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
}

/// One beats, takes what it gets, and delivers nothing: others do it, pass after pass.
TEST_F(FarmTest, AWorkerThatStandsStillHoldsNobodyUp) {
    make_workers(2);
    std::atomic<bool> over = false;
    renderers_[1] = make_hindered([&](const WorkUnit&) {
        for (int k = 0; k < 20'000 && !over; ++k)
            nap(1);
    });
    hooks_.on_pass = [&](const PassReport& report, const CombinedImage&) {
        if (report.plan.index + 1 == truth().passes.size()) over = true;
    };
    expect_truth(render());
    EXPECT_GT(copied_, 0u);
    EXPECT_TRUE(lost_.empty()) << "slow is not lost";
    EXPECT_EQ(bad_messages_, 0u) << "nor is it to blame";
}

/// A worker's messages as a liar sends them: it claims to trace a million paths a second, and delivers nothing.
FaultyChannel::Filter claims_only() {
    return [samples = std::uint64_t{0}](Bytes& bytes) mutable {
        if (is<Heartbeat>(bytes)) {
            auto beat = std::get<Heartbeat>(decode(bytes));
            beat.samples = samples += 1'000'000;
            beat.rays = ~std::uint64_t{0};
            bytes = encode(beat);
        }
        return !is<Result>(bytes);
    };
}

TEST_F(FarmTest, WorkersThatClaimProgressAndDeliverNothingHoldNobodyUp) {
    make_workers(4);
    first_ = 1;
    faulty_[1]->outgoing = claims_only();
    faulty_[2]->outgoing = claims_only();
    faulty_[3]->outgoing = [claim = claims_only()](Bytes& bytes) mutable {
        if (is<Hello>(bytes)) {
            auto hello = std::get<Hello>(decode(bytes));
            hello.threads = kMostThreads;
            bytes = encode(hello);
        }
        return claim(bytes);
    };
    expect_truth(render());
    EXPECT_GT(copied_, 0u);
    EXPECT_TRUE(lost_.empty()) << "slow is not lost";
}

/// Both workers have a thread that never ends a unit: each does what the other's is stuck in.
TEST_F(FarmTest, AStuckThreadAmongBusyOnesHoldsNobodyUp) {
    make_workers(2);
    std::atomic<bool> over = false;
    std::atomic<int> stuck[2] = {0, 0};
    for (std::size_t w = 0; w < 2; ++w)
        renderers_[w] = make_hindered([&over, &stuck = stuck[w]](const WorkUnit& unit) {
            if (unit.pass != 1 || stuck.exchange(1) != 0) return;
            for (int k = 0; k < 20'000 && !over; ++k)
                nap(1);
        });
    hooks_.on_pass = [&](const PassReport& report, const CombinedImage&) {
        if (report.plan.index == 1) {
            EXPECT_FALSE(over);
            over = true;
        }
    };
    expect_truth(render());
    EXPECT_EQ(stuck[0] + stuck[1], 2);
    EXPECT_GT(copied_, 1u);
    EXPECT_EQ(bad_messages_, 0u);
}

/// A unit over which a worker was lost is issued alone, to one that claims to trace it.
TEST_F(FarmTest, ASuspectIsCopiedAsWell) {
    make_workers(3);
    first_ = 0;
    std::atomic<bool> died = false;
    faulty_[0]->outgoing = [&](Bytes& bytes) {
        if (!is<Result>(bytes)) return true;
        died = faulty_[0]->cut = true;
        return false;
    };
    renderers_[2] = make_patient(died);
    faulty_[1]->outgoing = claims_only();
    settings_[0].silence_seconds = 1.0;
    expect_truth(render({.gather = 20, .lost = 0.3, .dismiss = 1}));
    EXPECT_EQ(lost_, std::set<int>{1});
}

/// What a slow worker delivers after others is dropped, the rest of it counts.
TEST_F(FarmTest, ASlowWorkerCostsTimeNotBits) {
    make_workers(3);
    job_.farm.update_seconds = 0.2;
    renderers_[1] = make_hindered([](const WorkUnit&) { nap(60); });
    expect_truth(render());
    EXPECT_TRUE(lost_.empty());
    EXPECT_EQ(bad_messages_, 0u);
}

/// Whoever traces the pixel 0,0 of the second pass falls silent for ever.
struct PoisonUnits : FarmTest {
    void make_mortal(int count) {
        make_workers(count);
        for (std::size_t w = 0; w < faulty_.size(); ++w) {
            settings_[w].silence_seconds = 1.0;
            renderers_[w] = make_hindered([channel = faulty_[w].get()](const WorkUnit& unit) {
                if (unit.pass == 1 && unit.x0 == 0 && unit.y0 == 0) channel->cut = true;
            });
        }
    }

    std::string death(const FarmLimits& limits) {
        try {
            render(limits);
        } catch (const RunError& error) {
            return error.what();
        }
        return "it went on";
    }
};

TEST_F(PoisonUnits, AUnitThatKillsThreeWorkersEndsTheRenderByItsName) {
    make_mortal(5);
    const std::string why = death({.gather = 20, .lost = 0.3, .dismiss = 0.5, .grace = 1});
    EXPECT_NE(why.find("3 workers were lost over the pixels from 0,0 to below "), std::string::npos) << why;
    EXPECT_NE(why.find("of pass 2; to trace them alone: treefarm render SCENE --debug-sample 2,0,0,"),
              std::string::npos)
        << why;
}

TEST_F(PoisonUnits, IsNamedWhereNobodyIsLeft) {
    make_mortal(2);
    const std::string why = death({.gather = 20, .lost = 0.3, .dismiss = 0.5, .grace = 0.5});
    EXPECT_NE(why.find("no worker is left: 2 were lost over the pixels from 0,0"), std::string::npos) << why;
}

}  // namespace
}  // namespace treefarm::test
