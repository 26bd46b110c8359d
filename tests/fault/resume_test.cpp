// SPDX-License-Identifier: Apache-2.0
// A render that goes on from any of its states, written and read, is the render that never stopped.
#include <array>
#include <filesystem>

#include "common/plan/resolve/resolved_file.h"
#include "coordinator/checkpoint/checkpoint_store.h"
#include "tests/fault/farm_fixture.h"
#include "tests/support/test_folder.h"

namespace treefarm::test {
namespace {

namespace fs = std::filesystem;

class Resume : public FarmTest {
  protected:
    const fs::path folder_ = fresh_test_folder();

    /// Ends the render after so many passes, and writes the state.
    void stop_after(std::size_t passes) {
        std::size_t done = 0;
        hooks_.on_state = [&](RenderState& state) { done = state.reports.size(); };
        hooks_.interrupted = [&] { return done == passes; };
        hooks_.on_last_state = [&](RenderState state) { write(state); };
        EXPECT_TRUE(render().interrupted);
        hooks_ = {};
        faulty_.clear();
    }

    /// Ends a render of two workers within a pass, once so much of it has come in: what the second brings is lost, and
    /// the first begins when that has got something to do.
    void stop_within(std::uint32_t pass, double share) {
        make_workers(2);
        double in_progress = 0;
        std::array<std::atomic<bool>, 16> second_has{};
        faulty_[1]->incoming = [&second_has](Bytes& bytes) {
            if (!is<Work>(bytes)) return true;
            const auto work = std::get<Work>(decode(bytes));
            if (!work.units.empty()) second_has.at(work.pass) = true;
            return true;
        };
        faulty_[1]->outgoing = [pass](Bytes& bytes) {
            return !is<Result>(bytes) || std::get<Result>(decode(bytes)).pass != pass;
        };
        renderers_[0] = [&](const Scene&, const Resolved& job) -> RenderUnit {
            return [&second_has, pass, render = fake_renderer(job)](const PassPlan& plan, auto&... args) {
                for (int k = 0; k < 20'000 && plan.index == pass && !second_has.at(pass); ++k)
                    std::this_thread::sleep_for(std::chrono::milliseconds(1));
                render(plan, args...);
            };
        };
        hooks_.on_progress = [&](const RenderProgress& progress) {
            const double before = truth().passes[pass].plan.first_sample, spp = truth().passes[pass].plan.spp;
            if (progress.pass == pass) in_progress = (progress.fraction * progress.spp_total - before) / spp;
        };
        hooks_.interrupted = [&] { return in_progress > share + 1e-9; };
        hooks_.on_last_state = [&](RenderState state) { write(state); };
        EXPECT_TRUE(render({.gather = 20, .lost = 20, .dismiss = 1}).interrupted);
        hooks_ = {};
        faulty_.clear();
    }

    void write(RenderState& state, const LoadedCheckpoint* loaded = nullptr) {
        CheckpointOrigin origin;
        origin.pixels = kWidth * kHeight;
        origin.resolved = write_resolved(job_);
        CheckpointStore(folder_, loaded).prepare(origin, state)();
    }

    LoadedCheckpoint load() {
        return load_checkpoint(folder_, [](const CheckpointOrigin&) {});
    }

    /// All passes of a render once more, by a schedule.
    RenderResult replay(const RenderResult& render) {
        std::vector<PassPlan> passes;
        for (const PassReport& report : render.passes)
            passes.push_back(report.plan);
        faulty_.clear();
        make_workers(1);
        start_worker(0);
        Farm farm(*channels_[0], job_, kScene, kFingerprint, quiet_log());
        farm.gather([] { return false; });
        const SdTree tree = initial_tree(Box3(Vec3(0.0f), Vec3(1.0f)), 1.0f);
        RenderResult result = run_passes(farm, job_, listed_passes(passes), tree, kWidth, kHeight, {});
        leave({}, {.dismiss = 20});
        return result;
    }

    RenderResult go_on(int workers, std::uint32_t threads) {
        make_workers(workers);
        for (WorkerSettings& settings : settings_)
            settings.threads = threads;
        resumed_ = load().state;
        return render();
    }
};

TEST_F(Resume, AfterAnyPassOnAnyFarmTheBitsAreThoseOfARenderThatNeverStopped) {
    const std::size_t passes = truth().passes.size();
    ASSERT_GE(passes, 4u);
    for (std::size_t k = 1; k < passes; ++k) {
        make_workers(2);
        stop_after(k);
        EXPECT_EQ(load().state.reports.size(), k);
        job_.farm.tile_size = k % 2 == 0 ? 32 : 5;
        expect_truth(go_on(1 + static_cast<int>(k) % 5, 1 + static_cast<std::uint32_t>(k % 3)));
        faulty_.clear();
        job_.farm.tile_size = 8;
    }
}

TEST_F(Resume, WithinAnyPassOnAnyFarmTheBitsAreThoseOfARenderThatNeverStopped) {
    int k = 0;
    for (std::uint32_t pass = 0; pass < truth().passes.size(); ++pass)
        for (const double share : {0.0, 0.3}) {
            stop_within(pass, share);
            const RenderState state = load().state;
            ASSERT_TRUE(state.partial) << "pass " << pass;
            EXPECT_EQ(state.reports.size(), pass);
            EXPECT_EQ(state.partial->plan.index, pass);
            EXPECT_GT(state.partial->done.weight(), 0u);
            EXPECT_LT(state.partial->done.weight(), std::uint64_t{kWidth} * kHeight * state.partial->plan.chunks);
            job_.farm.tile_size = k % 2 == 0 ? 32 : 5;
            expect_truth(go_on(1 + k % 5, 1 + static_cast<std::uint32_t>(k % 3)));
            faulty_.clear();
            job_.farm.tile_size = 8;
            ++k;
        }
}

TEST_F(Resume, ManyTimesWithinOnePass) {
    const auto last = static_cast<std::uint32_t>(truth().passes.size() - 1);
    stop_within(last, 0.0);
    for (const double share : {0.2, 0.4, 0.6}) {
        const std::uint64_t before = load().state.partial->done.weight();
        resumed_ = load().state;
        stop_within(last, share);
        EXPECT_GE(load().state.partial->done.weight(), before) << "nothing is traced twice";
    }
    expect_truth(go_on(3, 1));
}

TEST_F(Resume, CheckpointsWithinAPassAreMadeWhileItGoesOn) {
    make_workers(2);
    std::vector<RenderState> states;
    hooks_.state_due = [&] { return true; };
    hooks_.on_state = [&](RenderState& state) {
        if (state.partial && state.partial->plan.index >= 2 && states.size() < 5) states.push_back(state);
    };
    expect_truth(render());
    ASSERT_FALSE(states.empty());
    hooks_ = {};
    for (RenderState& state : states) {
        write(state);
        faulty_.clear();
        expect_truth(go_on(1, 2));
    }
}

TEST_F(Resume, ACheckpointWithinAPassSaysMoreThanTheOneBefore) {
    const auto last = static_cast<std::uint32_t>(truth().passes.size() - 1);
    stop_within(last, 0.4);
    std::uint64_t before = load().state.partial->done.weight();
    hooks_.state_due = [] { return true; };
    hooks_.on_state = [&](RenderState& state) {
        if (!state.partial) return;
        EXPECT_GT(state.partial->done.weight(), before);
        before = state.partial->done.weight();
    };
    expect_truth(go_on(2, 1));
}

TEST_F(Resume, WhatCannotBeUsedOfAPassIsTracedAgain) {
    stop_within(2, 0.0);
    RenderState state = load().state;
    state.partial->film.pop_back();
    write(state);
    expect_truth(go_on(2, 1));
}

TEST_F(Resume, APartialPassIsFinishedAsItWasBegunWhateverTheNewBudget) {
    const auto last = static_cast<std::uint32_t>(truth().passes.size() - 1);
    stop_within(last, 0.0);
    job_.budget.spp = 300;
    const RenderResult more = go_on(2, 2);
    EXPECT_EQ(more.passes[last].plan, truth().passes[last].plan);
    EXPECT_EQ(more.spp, 300u);
    const RenderResult replayed = replay(more);
    EXPECT_EQ(hash_text(replayed.image_hash), hash_text(more.image_hash));
    EXPECT_EQ(hash_text(replayed.tree_hash), hash_text(more.tree_hash));
}

TEST_F(Resume, ManyTimesInARow) {
    make_workers(2);
    stop_after(1);
    for (std::size_t k = 2; k < truth().passes.size(); ++k) {
        resumed_ = load().state;
        make_workers(3);
        stop_after(k);
    }
    expect_truth(go_on(2, 2));
}

TEST_F(Resume, AStateIsTheSameAfterItWasWrittenAndRead) {
    make_workers(2);
    stop_after(3);
    LoadedCheckpoint once = load();
    const std::vector<Section> first = encode_state(once.origin, once.state);
    write(once.state, &once);
    const LoadedCheckpoint twice = load();
    EXPECT_EQ(twice.generation, once.generation + 1);
    EXPECT_EQ(encode_state(twice.origin, twice.state), first);
    for (std::size_t k = 0; k < once.state.films.size(); ++k)
        EXPECT_EQ(encode_pixels(twice.state.films[k].pixels), encode_pixels(once.state.films[k].pixels));
}

TEST_F(Resume, TheTimeOfEarlierLivesCounts) {
    make_workers(2);
    stop_after(2);
    const double before = load().state.history.seconds;
    EXPECT_GT(before, 0);
    RenderState state = load().state;
    state.history.seconds = 1000;
    write(state);
    const RenderResult result = go_on(2, 1);
    EXPECT_GT(result.passes.back().run_seconds, 1000);
    EXPECT_LT(result.passes.back().run_seconds, 1000 + 60);
}

TEST_F(Resume, EachLifeReckonsWithItsOwnThreads) {
    make_workers(2);  // of two threads each
    stop_after(2);
    std::vector<std::uint32_t> before, now;
    hooks_.on_state = [&](RenderState& state) {
        before.clear();
        for (const PassFacts& pass : state.history.passes)
            before.push_back(pass.threads);
        now.push_back(state.history.threads);
    };
    const std::size_t passes = go_on(3, 1).passes.size();
    ASSERT_GE(passes, 4u);
    std::vector<std::uint32_t> expected(passes, 3);
    expected[0] = expected[1] = 4;
    EXPECT_EQ(before, expected);
    EXPECT_EQ(now, std::vector<std::uint32_t>(passes - 2, 3));
}

TEST_F(Resume, OneThatIsDoneGoesOnToMoreSamplesAsItsScheduleDoes) {
    make_workers(2);
    hooks_.on_last_state = [&](RenderState state) { write(state); };
    expect_truth(render());
    hooks_ = {};
    faulty_.clear();
    job_.budget.spp = 500;
    const RenderResult more = go_on(3, 1);
    EXPECT_EQ(more.spp, 500u);
    const RenderResult replayed = replay(more);
    EXPECT_EQ(hash_text(replayed.image_hash), hash_text(more.image_hash));
    EXPECT_EQ(hash_text(replayed.tree_hash), hash_text(more.tree_hash));
}

TEST_F(Resume, StoppedBeforeItsLastPassAndGivenMoreItIsWhatItsScheduleSays) {
    make_workers(2);
    stop_after(truth().passes.size() - 1);  // the tree was refined as the last one
    ASSERT_TRUE(load().state.last_tree.value());
    job_.budget.spp = 700;
    const RenderResult more = go_on(2, 2);
    EXPECT_EQ(more.spp, 700u);
    EXPECT_TRUE(more.passes[truth().passes.size() - 1].plan.last_tree);
    EXPECT_TRUE(more.passes[truth().passes.size() - 1].plan.record) << "there is more to come";
}

}  // namespace
}  // namespace treefarm::test
