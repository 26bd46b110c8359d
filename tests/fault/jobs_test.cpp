// SPDX-License-Identifier: Apache-2.0
// Several jobs, one after the other, over the same workers.
#include <atomic>

#include "tests/fault/farm_fixture.h"

namespace treefarm::test {
namespace {

constexpr FarmLimits kShortJob{.gather = 1, .lost = 0.3, .dismiss = 20};

class JobsTest : public FarmTest {
  protected:
    JobsTest() { stay_ = true; }
    ~JobsTest() override {
        if (!threads_.empty()) leave(lost_, {.dismiss = 20});
    }

    /// The next job of the study.
    RenderResult next(const FarmLimits& limits = {.gather = 20, .lost = 20, .dismiss = 20}) {
        turn_ = {turn_.number + 1, lost_};
        return render(limits);
    }
};

TEST_F(JobsTest, WorkersStayAndEachJobIsItself) {
    make_workers(3);
    std::atomic<int> scene_chunks{0};
    for (const auto& channel : faulty_)
        channel->incoming = [&](Bytes& bytes) {
            if (is<Chunk>(bytes) && std::get<Chunk>(decode(bytes)).blob == Blob::scene) ++scene_chunks;
            return true;
        };
    expect_truth(next());
    const int sent_once = scene_chunks;
    EXPECT_GE(sent_once, 3 * 3);
    for (int k = 0; k < 4; ++k) {
        job_.sampler.seed = 1;
        EXPECT_NE(next().image_hash, truth().image_hash);
        job_.sampler.seed = 0;
        expect_truth(next());
    }
    EXPECT_EQ(scene_chunks, sent_once) << "workers hold the scene already";
    EXPECT_TRUE(lost_.empty());
    leave(lost_, {.dismiss = 20});
    EXPECT_TRUE(orderly_);
}

TEST_F(JobsTest, ALostWorkerIsNotWaitedForAndMayComeBack) {
    make_workers(2);
    expect_truth(next());
    faulty_[0]->cut = true;
    expect_truth(next(kShortJob));
    EXPECT_EQ(lost_, std::set<int>{1});
    const Timer timer;
    expect_truth(next());
    EXPECT_LT(timer.seconds(), 15) << "gathering waits for 20 s";
    EXPECT_EQ(lost_, std::set<int>{1}) << "it is still lost";
    faulty_[0]->cut = false;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    for (int k = 0; k < 100 && !lost_.empty(); ++k)
        expect_truth(next());
    EXPECT_TRUE(lost_.empty());
}

TEST_F(JobsTest, AFailureEndsOneJobOnly) {
    make_workers(1);
    renderers_[0] = [make = make_fake()](const Scene& scene, const Resolved& job) {
        if (job.sampler.seed == 13) throw RunError("an unlucky seed");
        return make(scene, job);
    };
    expect_truth(next());
    job_.sampler.seed = 13;
    EXPECT_THROW(next(), RunError);
    job_.sampler.seed = 0;
    lost_ = {1};
    expect_truth(next());
}

/// Pieces of one job's tree that arrive in the next must not become its tree.
TEST_F(JobsTest, LatePiecesOfAnEarlierTreeAreNotKept) {
    make_workers(2);
    std::vector<Bytes> old_trees;
    faulty_[1]->incoming = [&, job = 0u](Bytes& bytes) mutable {
        if (is<Rejoin>(bytes)) job = std::get<Rejoin>(decode(bytes)).job;
        if (is<Chunk>(bytes) && job == 1 && std::get<Chunk>(decode(bytes)).blob == Blob::tree)
            old_trees.push_back(bytes);
        if (!is<Work>(bytes) || job != 2) return true;
        for (const Bytes& tree : std::exchange(old_trees, {}))  // before the second tree of the second job
            channels_[2]->send(2, std::make_shared<const Bytes>(tree));
        return true;
    };
    job_.sampler.seed = 1;
    next();
    job_.sampler.seed = 0;
    expect_truth(next());
    EXPECT_TRUE(lost_.empty());
}

}  // namespace
}  // namespace treefarm::test
