#include "coordinator/farm.h"

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <thread>

#include "common/base/hash.h"
#include "common/base/random.h"
#include "common/comm/in_process_channel.h"
#include "coordinator/pass_loop.h"
#include "worker/worker_loop.h"

namespace treefarm {
namespace {

constexpr int kWidth = 45, kHeight = 30;
constexpr std::uint64_t kFingerprint = 7;
const Bytes kScene(3'000'000, 42);  // three chunks

Job test_job() {
    Job job;
    job.budget.spp = 100;
    job.guiding.spp_unit = 4;
    job.guiding.spatial_threshold = 100;
    job.farm.tile_size = 8;
    job.farm.heartbeat_seconds = 0.02;
    job.farm.update_seconds = 0.01;
    return job;
}

Log quiet_log() {
    return std::make_shared<spdlog::logger>("test");
}

/// A renderer without a scene: radiance and records come straight from the keyed generator.
RenderUnit fake_renderer(const Job& job) {
    return [job](const PassPlan& pass, const Guide& guide, const WorkUnit& unit, std::vector<PixelEstimate>& pixels,
                 RecordLog& log, TraceStats& stats) {
        const std::uint32_t run = kBlockSamples * pass.blocks_per_unit;
        const std::uint32_t first = run * unit.chunk, last = std::min(first + run, pass.spp);
        for (std::uint32_t y = unit.y0; y < unit.y1; ++y)
            for (std::uint32_t x = unit.x0; x < unit.x1; ++x) {
                std::vector<PixelEstimate> blocks;
                for (std::uint32_t sample = first; sample < last; ++sample) {
                    if (sample % kBlockSamples == 0) blocks.emplace_back();
                    const PathKey key{job.sampler.seed, y * kWidth + x, pass.first_sample + sample};
                    const Draw d = draw(key, 0, Stream::scatter);
                    const float value = to_unit(d[0]);
                    blocks.back().add(sample, Rgb(value, value * value, 1.0f));
                    ++stats.paths;
                    stats.rays += 2;
                    if (!pass.record) continue;
                    const std::uint32_t region = guide.region({to_unit(d[1]), to_unit(d[2]), 0.5f});
                    ++log.counts[region];
                    ++stats.records;
                    if (value > 0.5f) log.records.push_back({region, d[3] & d[1], d[2], value});
                }
                pixels.push_back(reduce_blocks(blocks));
            }
    };
}

MakeRenderer make_fake() {
    return [](std::span<const std::uint8_t> scene, const Job& job) {
        if (!std::equal(scene.begin(), scene.end(), kScene.begin(), kScene.end())) throw RunError("wrong scene");
        return fake_renderer(job);
    };
}

/// Does to a worker's messages what a bad network or a dying process would.
class FaultyChannel final : public Channel {
  public:
    using Filter = std::function<bool(Bytes&)>;  ///< may change the message; false: it is lost

    explicit FaultyChannel(Channel& inner) : inner_(inner) {}
    Filter outgoing, incoming;
    std::atomic<bool> cut{false};  ///< nothing passes in either direction

    int self() const override { return inner_.self(); }
    int peer_count() const override { return inner_.peer_count(); }
    void send(int peer, Payload payload) override {
        Bytes bytes = *payload;
        if (cut || (outgoing && !outgoing(bytes)) || cut) return;
        inner_.send(peer, std::make_shared<const Bytes>(std::move(bytes)));
    }
    std::optional<Received> poll() override {
        if (cut) return std::nullopt;
        auto message = inner_.poll();
        if (message && incoming && !incoming(message->bytes)) return std::nullopt;
        return message;
    }
    bool drained() override { return inner_.drained(); }
    void rest(double seconds) override {
        cut ? std::this_thread::sleep_for(std::chrono::milliseconds(1)) : inner_.rest(seconds);
    }
    std::uint64_t bytes_sent() const override { return inner_.bytes_sent(); }
    std::uint64_t bytes_received() const override { return inner_.bytes_received(); }

  private:
    Channel& inner_;
};

template <class M>
bool is(const Bytes& bytes) {
    return open_envelope(bytes).kind == M::kKind;
}

/// A coordinator in the test's thread and workers in threads of their own.
class FarmTest : public ::testing::Test {
  protected:
    void make_workers(int count) {
        channels_ = make_in_process_channels(count + 1);
        for (int w = 1; w <= count; ++w)
            faulty_.push_back(std::make_unique<FaultyChannel>(*channels_[std::size_t(w)]));
        settings_.assign(std::size_t(count), {2, "here", kFingerprint, 60.0});
        renderers_.assign(std::size_t(count), make_fake());
        ends_.assign(std::size_t(count), WorkerEnd::orderly);
    }

    void start_worker(std::size_t w) {
        threads_.emplace_back(
            [this, w] { ends_[w] = run_worker(*faulty_[w], settings_[w], renderers_[w], quiet_log()); });
    }

    /// Starts all workers, renders, sends them away.
    RenderResult render(const FarmLimits& limits = {.gather = 20, .lost = 20, .dismiss = 20}) {
        if (threads_.empty())
            for (std::size_t w = 0; w < faulty_.size(); ++w)
                start_worker(w);
        Farm farm(*channels_[0], job_, kScene, kFingerprint, quiet_log(), limits);
        RenderResult result;
        try {
            farm.gather([] { return false; });
            const SdTree tree = initial_tree(Box3(Vec3(0.0f), Vec3(1.0f)), 1.0f);
            result = run_passes(farm, job_, plan_passes(job_), tree, kWidth, kHeight, {});
        } catch (...) {
            leave(farm.lost_peers(), limits);
            throw;
        }
        reissued_ = farm.reissued_units();
        dropped_ = farm.dropped_results();
        lost_ = farm.lost_peers();
        leave(lost_, limits);
        return result;
    }

    void leave(const std::set<int>& lost, const FarmLimits& limits) {
        orderly_ = dismiss_workers(*channels_[0], lost, limits.dismiss);
        for (std::thread& thread : threads_)
            thread.join();
        threads_.clear();
    }

    /// What one undisturbed worker with one thread makes of it.
    static const RenderResult& truth() {
        static const RenderResult result = [] {
            struct Plain : FarmTest {
                void TestBody() override {}
                RenderResult run() {
                    make_workers(1);
                    settings_[0].threads = 1;
                    return render();
                }
            } plain;
            return plain.run();
        }();
        return result;
    }

    void expect_truth(const RenderResult& result) {
        EXPECT_EQ(hash_text(result.image_hash), hash_text(truth().image_hash));
        EXPECT_EQ(hash_text(result.tree_hash), hash_text(truth().tree_hash));
        EXPECT_EQ(result.spp, 100u);
        ASSERT_EQ(result.passes.size(), truth().passes.size());
        for (std::size_t k = 0; k < result.passes.size(); ++k) {
            EXPECT_EQ(result.passes[k].stats.paths, truth().passes[k].stats.paths) << "pass " << k;
            EXPECT_EQ(result.passes[k].stats.records, truth().passes[k].stats.records) << "pass " << k;
            EXPECT_EQ(result.passes[k].tree.cells, truth().passes[k].tree.cells) << "pass " << k;
        }
    }

    Job job_ = test_job();
    std::vector<std::unique_ptr<Channel>> channels_;
    std::vector<std::unique_ptr<FaultyChannel>> faulty_;
    std::vector<WorkerSettings> settings_;
    std::vector<MakeRenderer> renderers_;
    std::vector<WorkerEnd> ends_;
    std::vector<std::thread> threads_;
    std::uint64_t reissued_ = 0, dropped_ = 0;
    std::set<int> lost_;
    bool orderly_ = false;
};

/// Faults that are only seen by silence: short limits.
constexpr FarmLimits kShort{.gather = 20, .lost = 0.3, .dismiss = 20};

TEST_F(FarmTest, TheTruthTeaches) {
    EXPECT_GT(truth().passes.back().tree.regions, 4u) << "the test must exercise refinement";
    EXPECT_GT(truth().passes.size(), 2u);
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
    settings_[1].silence_seconds = 1.0;
    int results = 0;
    faulty_[1]->outgoing = [&](Bytes& bytes) {
        if (is<Result>(bytes) && ++results == 3) faulty_[1]->cut = true;
        return true;
    };
    expect_truth(render(kShort));
    EXPECT_EQ(lost_, std::set<int>{2});
    EXPECT_GT(reissued_, 0u);
    EXPECT_FALSE(orderly_);
    EXPECT_EQ(ends_[1], WorkerEnd::orphaned);
    EXPECT_EQ(ends_[0], WorkerEnd::disorderly);
}

TEST_F(FarmTest, AWorkerThatWasThoughtLostJoinsAgain) {
    make_workers(2);
    int results = 0;
    std::thread mend;
    faulty_[1]->outgoing = [&](Bytes& bytes) {
        if (is<Result>(bytes) && ++results == 2) {
            faulty_[1]->cut = true;
            mend = std::thread([&] {
                std::this_thread::sleep_for(std::chrono::milliseconds(900));
                faulty_[1]->cut = false;
            });
        }
        return true;
    };
    // The other worker is slow, so that there is something left to join.
    renderers_[0] = [](std::span<const std::uint8_t>, const Job& job) -> RenderUnit {
        return [render = fake_renderer(job)](auto&... args) {
            std::this_thread::sleep_for(std::chrono::milliseconds(15));
            render(args...);
        };
    };
    const RenderResult result = render(kShort);
    mend.join();
    expect_truth(result);
    EXPECT_GT(reissued_, 0u);
    EXPECT_TRUE(lost_.empty()) << "it is back";
    EXPECT_TRUE(orderly_);
}

TEST_F(FarmTest, ACorruptResultCostsTheWorkerItsPlace) {
    make_workers(2);
    int results = 0;
    faulty_[0]->outgoing = [&](Bytes& bytes) {
        if (is<Result>(bytes) && ++results == 2) bytes[bytes.size() / 2] ^= 0x10;
        return true;
    };
    expect_truth(render());
    EXPECT_EQ(lost_, std::set<int>{1});
}

TEST_F(FarmTest, AResultThatLiesIsRefused) {
    make_workers(2);
    int results = 0;
    faulty_[0]->outgoing = [&](Bytes& bytes) {
        if (!is<Result>(bytes) || ++results != 2) return true;
        auto result = std::get<Result>(decode(bytes));
        ++result.units[0].unit.x0;  // work that it was not given
        ++result.units[0].unit.x1;
        bytes = encode(result);
        return true;
    };
    expect_truth(render());
    EXPECT_EQ(lost_, std::set<int>{1});
}

TEST_F(FarmTest, AResultThatComesTwiceCountsOnce) {
    make_workers(2);
    int results = 0;
    faulty_[0]->outgoing = [&](Bytes& bytes) {
        if (is<Result>(bytes) && ++results == 2) channels_[1]->send(0, std::make_shared<const Bytes>(bytes));
        return true;
    };
    expect_truth(render());
    EXPECT_EQ(lost_, std::set<int>{1});
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
    const MakeRenderer broken = [](std::span<const std::uint8_t>, const Job& job) -> RenderUnit {
        return [render = fake_renderer(job)](const PassPlan& pass, auto&... args) {
            if (pass.index == 1) throw RunError("the disk is on fire");
            render(pass, args...);
        };
    };
    make_workers(2);
    renderers_[0] = broken;
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
    renderers_[0] = [&](std::span<const std::uint8_t>, const Job& job) -> RenderUnit {
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

TEST_F(FarmTest, WorkersLeaveWhenTheCoordinatorFallsSilent) {
    make_workers(1);
    settings_[0].silence_seconds = 0.05;
    EXPECT_EQ(run_worker(*faulty_[0], settings_[0], renderers_[0], quiet_log()), WorkerEnd::orphaned);
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
    hooks.on_pass = [&](const PassReport&) { ++passes; };
    hooks.interrupted = [&] { return passes == 2; };
    const SdTree tree = initial_tree(Box3(Vec3(0.0f), Vec3(1.0f)), 1.0f);
    const RenderResult result = run_passes(farm, job_, plan_passes(job_), tree, kWidth, kHeight, hooks);
    leave({}, {.dismiss = 20});
    EXPECT_TRUE(result.interrupted);
    EXPECT_EQ(result.spp, 12u);
    EXPECT_EQ(result.passes.size(), 2u);
    EXPECT_EQ(result.image.mean.size(), static_cast<std::size_t>(kWidth * kHeight));
}

}  // namespace
}  // namespace treefarm
