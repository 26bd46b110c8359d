// SPDX-License-Identifier: Apache-2.0
#include "tests/fault/farm_fixture.h"

namespace treefarm::test {
namespace {

/// Faults that are only seen by silence: short limits.
constexpr FarmLimits kShort{.gather = 20, .lost = 0.3, .dismiss = 20};

TEST_F(FarmTest, TheTruthTeaches) {
    EXPECT_GT(truth().passes.back().tree.regions, 4u) << "the test must exercise refinement";
    EXPECT_GT(truth().passes.size(), 2u);
    EXPECT_EQ(truth().aovs->size(), 3u + 1 + 1 + 3 + 3 + 1);
    EXPECT_NE(truth().aov_hash, 0u);
}

TEST_F(FarmTest, AnyNumberOfWorkersGivesTheSameBits) {
    for (const int workers : {1, 3, 5}) {
        channels_.clear();
        faulty_.clear();
        make_workers(workers);
        expect_truth(render());
        EXPECT_TRUE(orderly_);
        EXPECT_EQ(reissued_, 0u);
        for (const WorkerEnd end : ends_)
            EXPECT_EQ(end, WorkerEnd::orderly);
    }
}

TEST_F(FarmTest, AWorkerThatDiesIsReplaced) {
    make_workers(3);
    first_ = 1;
    settings_[1].silence_seconds = 1.0;
    std::atomic<bool> dead = false;
    renderers_[0] = renderers_[2] = make_patient(dead);
    int results = 0;
    std::future<void> noticed;  // copies by the others would end the render before its silence has been noticed
    faulty_[1]->outgoing = [&](Bytes& bytes) {
        if (!is<Result>(bytes) || ++results != 1) return true;
        faulty_[1]->cut = true;
        noticed = std::async(std::launch::async, [&] {
            std::this_thread::sleep_for(std::chrono::duration<double>(2 * kShort.lost));
            dead = true;
        });
        return true;
    };
    expect_truth(render(kShort));
    EXPECT_EQ(lost_, std::set<int>{2});
    EXPECT_GT(reissued_ + copied_, 0u);
    EXPECT_FALSE(orderly_);
    EXPECT_EQ(ends_[1], WorkerEnd::orphaned);
    EXPECT_EQ(ends_[0], WorkerEnd::disorderly);
}

/// Whoever stands first in the chain passes the scene on: dead or stopped before it has, it must starve nobody. That it
/// is gone is not even noticed here.
TEST_F(FarmTest, ADeadHeadOfTheChainStarvesNobody) {
    const std::function<bool(const Bytes&)> moments[] = {
        [](const Bytes& b) { return is<Welcome>(b); },
        [](const Bytes& b) { return is<Chunk>(b); },
        [pieces = 0](const Bytes& b) mutable { return is<Chunk>(b) && ++pieces == 2; },
        [](const Bytes& b) { return is<PassBegin>(b); },
    };
    for (const auto& moment : moments) {
        channels_.clear();
        faulty_.clear();
        make_workers(3);
        settings_[0].silence_seconds = 1.0;
        faulty_[0]->incoming = [&, dies = moment](Bytes& bytes) mutable {
            if (dies(bytes)) faulty_[0]->cut = true;
            return !faulty_[0]->cut;
        };
        expect_truth(render({.gather = 20, .lost = 20, .dismiss = 0.5}));
    }
}

TEST_F(FarmTest, AWorkerThatWasThoughtLostJoinsAgain) {
    make_workers(2);
    first_ = 1;
    int results = 0;
    int hellos = 0;
    std::atomic<bool> back = false;
    std::thread mend;
    faulty_[1]->outgoing = [&](Bytes& bytes) {
        if (is<Hello>(bytes) && ++hellos == 2) back = true;
        if (is<Result>(bytes) && ++results == 1) {
            faulty_[1]->cut = true;
            mend = std::thread([&] {
                std::this_thread::sleep_for(std::chrono::milliseconds(1500));  // five times the limit
                faulty_[1]->cut = false;
            });
        }
        return true;
    };
    // The other worker waits for it to be back, so that there is something left to join. It itself is still tracing
    // when it is told to join again: that work was issued anew and must not be sent.
    renderers_[0] = make_patient(back);
    renderers_[1] = [&](const Scene&, const Resolved& job) -> RenderUnit {
        return [&, render = fake_renderer(job)](auto&... args) {
            for (int k = 0; k < 20'000 && !back && (k < 5 || faulty_[1]->cut); ++k)
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
            render(args...);
        };
    };
    bool dropped = false;  // its tree comes late, so that there is time to send what must not be sent
    faulty_[1]->incoming = [&](Bytes& bytes) { return !back || !is<Chunk>(bytes) || std::exchange(dropped, true); };
    const RenderResult result = render(kShort);
    mend.join();
    expect_truth(result);
    EXPECT_EQ(hellos, 2);
    EXPECT_GT(reissued_, 0u);
    EXPECT_TRUE(lost_.empty()) << "it is back";
    EXPECT_TRUE(orderly_);
}

TEST_F(FarmTest, ACorruptResultExcludesTheWorker) {
    on_first_result([](Bytes& bytes) { bytes[bytes.size() / 2] ^= 0x10; });
    expect_truth(render());
    EXPECT_EQ(lost_, std::set<int>{1});
}

TEST_F(FarmTest, AForgedResultIsRefused) {
    change_first_result([](Result& result) {
        ++result.units[0].unit.x0;  // work that it was not given
        ++result.units[0].unit.x1;
    });
    expect_truth(render());
    EXPECT_EQ(lost_, std::set<int>{1});
}

TEST_F(FarmTest, AResultThatComesTwiceCountsOnce) {
    on_first_result([&](Bytes& bytes) {  // both copies arrive before the other worker delivers and its pass may end
        for (int k = 0; k < 2; ++k)
            channels_[1]->send(0, std::make_shared<const Bytes>(bytes));
    });
    expect_truth(render());
    EXPECT_EQ(lost_, std::set<int>{1});
}

/// The end of a pass would otherwise be spent on merging one small result after the other.
TEST_F(FarmTest, AWorkerWithoutAUnitForAMomentKeepsWhatItHas) {
    make_workers(3);
    job_.farm.update_seconds = 3600;
    std::atomic<std::size_t> results = 0;
    for (const auto& channel : faulty_)
        channel->outgoing = [&](Bytes& bytes) {
            results += is<Result>(bytes);
            return true;
        };
    const RenderResult result = render();
    expect_truth(result);
    EXPECT_LE(results, 3 * result.passes.size()) << "one of each worker that got any work";
}

TEST_F(FarmTest, MissingPiecesOfATreeAreAskedForAgain) {
    make_workers(3);
    std::atomic<int> lost_pieces = 0;
    faulty_[1]->incoming = [&](Bytes& bytes) {
        if (!is<Chunk>(bytes)) return true;
        const auto chunk = std::get<Chunk>(decode(bytes));
        if ((chunk.blob == Blob::tree && chunk.epoch == 1 && lost_pieces == 1) ||
            (chunk.blob == Blob::scene && chunk.offset > 0 && lost_pieces == 0)) {
            ++lost_pieces;
            return false;
        }
        return true;
    };
    expect_truth(render());
    EXPECT_EQ(lost_pieces, 2);
    EXPECT_TRUE(lost_.empty());
}

TEST_F(FarmTest, AWorkerOfAnotherBuildIsRefused) {
    make_workers(2);
    settings_[0].fingerprint = kFingerprint + 1;
    std::atomic<int> work = 0;
    faulty_[0]->incoming = [&](Bytes& bytes) {
        work += is<Work>(bytes);
        return true;
    };
    expect_truth(render());
    EXPECT_EQ(work, 0);
    EXPECT_TRUE(orderly_);
}

TEST_F(FarmTest, WithoutAUsableWorkerTheRunFailsWithTheReason) {
    make_workers(2);
    for (WorkerSettings& settings : settings_)
        settings.fingerprint = kFingerprint + 1;
    try {
        render();
        FAIL() << "rendered by refused workers";
    } catch (const RunError& error) {
        EXPECT_NE(std::string(error.what()).find("fingerprint"), std::string::npos) << error.what();
    }
}

TEST_F(FarmTest, AFailingWorkerIsReplacedAndTheLastOneEndsTheRun) {
    std::atomic<bool> failed = false;
    const MakeRenderer broken = [&](const Scene&, const Resolved&) -> RenderUnit {
        return [&](auto&...) {
            failed = true;
            throw RunError("the disk is on fire");
        };
    };
    make_workers(2);
    first_ = 0;
    renderers_ = {broken, make_patient(failed)};
    expect_truth(render());
    EXPECT_EQ(lost_, std::set<int>{1});

    channels_.clear();
    faulty_.clear();
    make_workers(2);
    renderers_ = {broken, broken};
    try {
        render();
        FAIL() << "rendered by broken workers";
    } catch (const RunError& error) {
        EXPECT_NE(std::string(error.what()).find("the disk is on fire"), std::string::npos) << error.what();
    }
}

TEST_F(FarmTest, ALatecomerJoins) {
    make_workers(2);
    job_.farm.heartbeat_seconds = 0.02;
    std::atomic<bool> started = false;
    std::atomic<int> work_of_latecomer = 0;
    renderers_[0] = [&](const Scene&, const Resolved& job) -> RenderUnit {
        return [&, render = fake_renderer(job)](auto&... args) {
            started = true;
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
            render(args...);
        };
    };
    faulty_[1]->incoming = [&](Bytes& bytes) {
        work_of_latecomer += is<Work>(bytes);
        return true;
    };
    start_worker(0);
    threads_.emplace_back([&] {
        while (!started)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        ends_[1] = run_worker(*faulty_[1], settings_[1], renderers_[1], quiet_log());
    });
    expect_truth(render({.gather = 0.2, .lost = 20, .dismiss = 20}));
    EXPECT_GT(work_of_latecomer, 0);
    EXPECT_TRUE(orderly_);
}

TEST_F(FarmTest, AWorkerWithoutThreadsIsRefused) {
    make_workers(1);
    settings_[0].threads = 0;
    EXPECT_THROW(render(kShort), RunError);
}

TEST_F(FarmTest, WorkersCanBeSentAwayBeforeAnythingStarted) {
    make_workers(3);
    for (std::size_t w = 0; w < 3; ++w)
        start_worker(w);
    leave({}, {.dismiss = 20});
    EXPECT_TRUE(orderly_);
    for (const WorkerEnd end : ends_)
        EXPECT_EQ(end, WorkerEnd::orderly);
}

TEST_F(FarmTest, AnInterruptionKeepsWholePasses) {
    make_workers(2);
    for (std::size_t w = 0; w < 2; ++w)
        start_worker(w);
    Farm farm(*channels_[0], job_, kScene, kFingerprint, quiet_log());
    farm.gather([] { return false; });
    int passes = 0;
    PassHooks hooks;
    hooks.on_pass = [&](const PassReport&, const CombinedImage&) { ++passes; };
    hooks.interrupted = [&] { return passes == 2; };
    const SdTree tree = initial_tree(Box3(Vec3(0.0f), Vec3(1.0f)), 1.0f);
    const RenderResult result = run_passes(farm, job_, passes_of(job_), tree, kWidth, kHeight, hooks);
    leave({}, {.dismiss = 20});
    EXPECT_TRUE(result.interrupted);
    EXPECT_EQ(result.spp, 12u);
    EXPECT_EQ(result.passes.size(), 2u);
    EXPECT_EQ(result.image->mean.size(), static_cast<std::size_t>(kWidth * kHeight));
}

}  // namespace
}  // namespace treefarm::test
