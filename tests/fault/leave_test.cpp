// SPDX-License-Identifier: Apache-2.0
// Workers that are told to leave while a render goes on, as a batch system does before it takes a host away.
#include "tests/fault/farm_fixture.h"

namespace treefarm::test {
namespace {

class Leaving : public FarmTest {
  protected:
    std::atomic<bool> told_ = false;

    /// A worker is told to leave when it sends its `count`-th result.
    void tell_at_result(std::size_t worker, int count) {
        settings_[worker].told_to_leave = [this] { return told_.load(); };
        faulty_[worker]->outgoing = [this, count, results = 0](Bytes& bytes) mutable {
            if (is<Result>(bytes) && ++results == count) told_ = true;
            return true;
        };
    }
};

TEST_F(Leaving, OneOfThreeAtAnyMomentCostsNoBit) {
    for (const int count : {1, 2, 3}) {
        make_workers(3);
        first_ = 1;
        renderers_[0] = renderers_[2] = make_patient(told_, 10);
        tell_at_result(1, count);
        expect_truth(render());
        EXPECT_TRUE(told_);
        EXPECT_TRUE(lost_.empty()) << "it waits for its dismissal";
        EXPECT_TRUE(orderly_);
        EXPECT_EQ(bad_messages_, 0u);
        told_ = false;
        faulty_.clear();
    }
}

TEST_F(Leaving, BeforeItHasAnything) {
    make_workers(2);
    told_ = true;
    settings_[0].told_to_leave = [this] { return told_.load(); };
    expect_truth(render());
    EXPECT_TRUE(orderly_);
}

TEST_F(Leaving, WhatTakesTooLongIsGivenBack) {
    job_.farm.leave_seconds = 0.05;
    make_workers(2);
    first_ = 0;
    std::atomic<bool> given_back = false, never = false;
    settings_[0].threads = 1;
    settings_[0].told_to_leave = [this] { return told_.load(); };
    renderers_[0] = [&](const Scene&, const Resolved& job) -> RenderUnit {
        return [&, render = fake_renderer(job)](auto&... args) {
            told_ = true;
            for (int k = 0; k < 20'000 && !given_back; ++k)
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
            render(args...);
        };
    };
    renderers_[1] = make_patient(told_);
    faulty_[0]->outgoing = [&](Bytes& bytes) {
        if (is<Bye>(bytes)) given_back = true;
        if (is<Result>(bytes)) never = true;
        return true;
    };
    expect_truth(render());
    EXPECT_TRUE(given_back);
    EXPECT_FALSE(never) << "what was given back is not sent";
    EXPECT_GT(reissued_, 0u);
}

TEST_F(Leaving, NoLaterJobWaitsForIt) {
    make_workers(2);
    first_ = 1;
    tell_at_result(1, 1);
    stay_ = true;
    turn_.number = 1;
    expect_truth(render());
    turn_ = {2, {}, {2}};
    stay_ = false;
    expect_truth(render({.gather = 1e9, .lost = 20, .dismiss = 20}));
    EXPECT_TRUE(orderly_);
}

TEST_F(Leaving, TheLastOneEndsTheRenderWhichCanBeGoneOnWith) {
    make_workers(1);
    tell_at_result(0, 3);
    std::optional<RenderState> last;
    hooks_.on_last_state = [&](RenderState state) { last = std::move(state); };
    try {
        render({.gather = 20, .lost = 20, .dismiss = 20, .grace = 0.2});
        FAIL() << "nobody is left";
    } catch (const NoWorkerLeft& error) {
        EXPECT_FALSE(error.was_stopped());
        EXPECT_NE(std::string(error.what()).find("no worker is left"), std::string::npos) << error.what();
    }
    hooks_ = {};
    ASSERT_TRUE(last);
    faulty_.clear();
    make_workers(2);
    resumed_ = std::move(last);
    expect_truth(render());
}

/// As by SIGSTOP, or on a laptop that slept: its workers leave after 30 s of silence.
TEST_F(Leaving, AfterALongSilenceOfTheCoordinatorThatIsToldAsTheReason) {
    make_workers(1);
    tell_at_result(0, 3);
    hooks_.on_progress = [this](const RenderProgress&) {
        if (told_) std::this_thread::sleep_for(std::chrono::milliseconds(200));
    };
    try {
        render({.gather = 20, .lost = 20, .dismiss = 20, .grace = 0.2, .heard = 0.1});
        FAIL() << "nobody is left";
    } catch (const NoWorkerLeft& error) {
        EXPECT_TRUE(error.was_stopped());
        EXPECT_NE(std::string(error.what()).find("this process was stopped for 0 s"), std::string::npos)
            << error.what();
    }
}

}  // namespace
}  // namespace treefarm::test
