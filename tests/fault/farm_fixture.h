// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <future>
#include <memory>
#include <set>
#include <thread>
#include <utility>

#include "common/base/hash.h"
#include "common/comm/in_process_channel.h"
#include "common/config/aov_list.h"
#include "common/scene/pack/scene_codec.h"
#include "coordinator/farm/farm.h"
#include "coordinator/passes/pass_loop.h"
#include "tests/support/fake_work.h"
#include "worker/worker_loop.h"

namespace treefarm::test {

inline constexpr int kWidth = 45, kHeight = 30;
inline constexpr std::uint64_t kFingerprint = 7;

/// A scene of three chunks, by an image that nothing uses.
inline Scene long_scene() {
    Scene scene;
    TextureImage& image = scene.images.emplace_back();
    image.width = image.height = 1000;
    image.bytes.assign(3'000'000, 42);
    return scene;
}

inline const Bytes kScene = encode_scene(long_scene());

inline Job test_job() {
    Job job;
    job.budget.spp = 100;
    job.guiding.spp_unit = 4;
    job.guiding.spatial_threshold = 100;
    job.farm.tile_size = 8;
    job.output.aovs = "albedo,depth,material,direct,indirect,spp";
    job.farm.heartbeat_seconds = 0.02;
    job.farm.update_seconds = 0.01;
    return job;
}

inline Log quiet_log() {
    return std::make_shared<spdlog::logger>("test");
}

/// AOVs of a unit, from the keyed generator as its pixels are.
inline void fill_aovs(const AovLayout& layout, const Job& job, const PassPlan& pass, const WorkUnit& unit,
                      UnitOutput& output) {
    const std::uint32_t run = kBlockSamples * pass.blocks_per_unit;
    const std::uint32_t first = run * unit.chunk, last = std::min(first + run, pass.spp);
    for (std::uint32_t y = unit.y0; y < unit.y1; ++y)
        for (std::uint32_t x = unit.x0; x < unit.x1; ++x) {
            std::vector<double> blocks;
            for (std::uint32_t sample = first; sample < last; ++sample) {
                if (sample % kBlockSamples == 0) blocks.resize(blocks.size() + layout.size());
                const Draw d = draw({job.sampler.seed, y * kWidth + x, pass.first_sample + sample}, 0, Stream::light);
                for (std::size_t i = 0; i < layout.size(); ++i)
                    blocks[blocks.size() - layout.size() + i] += 0.1 * to_unit(d[i % 4]);
            }
            reduce_aov_blocks(layout, blocks);
            blocks.resize(layout.size());
            output.aovs.values.insert(output.aovs.values.end(), blocks.begin(), blocks.end());
        }
    if (layout.direct()) output.aovs.direct = output.pixels;
}

inline RenderUnit fake_renderer(const Job& job) {
    return [job, layout = AovLayout(aov_requests(job)), render = fake_renderer(job.sampler.seed, kWidth)](
               const PassPlan& pass, const AnySampler& guide, const WorkUnit& unit, UnitOutput& output) {
        render(pass, guide, unit, output);
        fill_aovs(layout, job, pass, unit, output);
    };
}

inline MakeRenderer make_fake() {
    return [](const Scene& scene, const Resolved& job) {
        if (encode_scene(scene) != kScene) throw RunError("wrong scene");
        return fake_renderer(job);
    };
}

/// The fake renderer, but it waits with every unit until `flag` is up, at most so long: so that the fault under test
/// comes to pass.
inline MakeRenderer make_patient(const std::atomic<bool>& flag, int milliseconds = 20'000) {
    return [&flag, milliseconds](const Scene&, const Resolved& job) -> RenderUnit {
        return [&flag, milliseconds, render = fake_renderer(job)](auto&... args) {
            for (int k = 0; k < milliseconds && !flag; ++k)
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
            render(args...);
        };
    };
}

/// Does to a worker's messages what a bad network or a dying process would.
class FaultyChannel final : public Channel {
  public:
    using Filter = std::function<bool(Bytes&)>;  ///< may change the message; false: it is lost

    explicit FaultyChannel(Channel& inner) : inner_(inner) {}
    Filter outgoing, incoming;
    std::atomic<bool> cut{false};     ///< nothing passes in either direction
    std::atomic<bool> worked{false};  ///< work has come
    std::atomic<int> nap_ms{0};       ///< the next rest takes so long, and the look after it sees nothing yet
    /// For so long nothing passes in either direction; then all comes, in order: a cable that was pulled and plugged
    /// in.
    std::atomic<int> held_ms{0};

    int self() const override { return inner_.self(); }
    int peer_count() const override { return inner_.peer_count(); }
    void send(int peer, Payload payload) override {
        Bytes bytes = *payload;
        if (cut || (outgoing && !outgoing(bytes)) || cut) return;
        waiting_.emplace_back(peer, std::make_shared<const Bytes>(std::move(bytes)));
        if (!holds()) deliver();
    }
    std::optional<Received> poll() override {
        if (holds()) return std::nullopt;
        deliver();
        if (cut || std::exchange(woken_, false)) return std::nullopt;
        auto message = inner_.poll();
        if (message && incoming && !incoming(message->bytes)) return std::nullopt;
        if (message && brings_work(message->bytes)) worked = true;
        return message;
    }
    bool drained() override { return inner_.drained(); }
    void rest(double seconds) override {
        if (const int nap = nap_ms.exchange(0)) {
            std::this_thread::sleep_for(std::chrono::milliseconds(nap));
            woken_ = true;
            return;
        }
        cut ? std::this_thread::sleep_for(std::chrono::milliseconds(1)) : inner_.rest(seconds);
    }
    std::uint64_t bytes_sent() const override { return inner_.bytes_sent(); }
    std::uint64_t bytes_received() const override { return inner_.bytes_received(); }

  private:
    static bool brings_work(const Bytes& bytes) {
        try {
            return open_envelope(bytes).kind == Work::kKind;
        } catch (const FormatError&) {  // a rogue's message
            return false;
        }
    }

    using Clock = std::chrono::steady_clock;

    bool holds() {
        if (const int pause = held_ms.exchange(0)) held_until_ = Clock::now() + std::chrono::milliseconds(pause);
        return Clock::now() < held_until_;
    }
    void deliver() {
        for (auto& [peer, payload] : waiting_)
            if (!cut) inner_.send(peer, std::move(payload));
        waiting_.clear();
    }

    Channel& inner_;
    bool woken_ = false;
    Clock::time_point held_until_{};
    std::vector<std::pair<int, Payload>> waiting_;
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

    /// Two workers. `act` gets the first one's first result on its way. Each holds units until the other one has some
    /// and `act` has returned: no pass ends before.
    void on_first_result(std::function<void(Bytes&)> act) {
        make_workers(2);
        first_ = 0;
        renderers_[0] = make_patient(faulty_[1]->worked);
        renderers_[1] = make_patient(sent_);
        faulty_[0]->outgoing = [this, act = std::move(act)](Bytes& bytes) {
            if (is<Result>(bytes) && !sent_) {
                act(bytes);
                sent_ = true;
            }
            return true;
        };
    }
    /// Two workers; `change` alters the first one's first result on its way.
    void change_first_result(std::function<void(Result&)> change) {
        on_first_result([change = std::move(change)](Bytes& bytes) {
            auto result = std::get<Result>(decode(bytes));
            change(result);
            bytes = encode(result);
        });
    }

    void start_worker(std::size_t w) {
        threads_.emplace_back([this, w] {
            for (int k = 0; first_ && w != *first_ && k < 20'000 && !faulty_[*first_]->worked; ++k)
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
            ends_[w] = run_worker(*faulty_[w], settings_[w], renderers_[w], quiet_log());
        });
    }

    /// Starts all workers unless they stayed, renders, sends them away unless they shall stay.
    RenderResult render(FarmLimits limits = {.gather = 20, .lost = 20, .dismiss = 20}) {
        if (first_) limits.gather = 0.2;  // nobody waits for the others
        if (threads_.empty())
            for (std::size_t w = 0; w < faulty_.size(); ++w)
                start_worker(w);
        Farm farm(*channels_[0], job_, kScene, kFingerprint, quiet_log(), limits, turn_);
        RenderResult result;
        try {
            farm.gather([] { return false; });
            RenderState begin = first_state(job_, initial_tree(Box3(Vec3(0.0f), Vec3(1.0f)), 1.0f), kWidth * kHeight);
            if (auto resumed = std::exchange(resumed_, std::nullopt)) begin = std::move(*resumed);
            const PassChooser chosen = passes_of(job_, begin.plans());
            const PassChooser passes = [&](const RenderHistory& state) {
                NextPass next = chosen(state);
                if (next.pass && change_pass_) change_pass_(*next.pass);
                return next;
            };
            result = run_passes(farm, job_, passes, std::move(begin), kWidth, kHeight, hooks_);
        } catch (...) {
            if (!stay_) leave(farm.lost_peers(), limits);
            throw;
        }
        reissued_ = farm.reissued_units();
        copied_ = farm.copied_units();
        dropped_ = farm.dropped_results();
        bad_messages_ = farm.bad_messages();
        lost_ = farm.lost_peers();
        if (!stay_) leave(lost_, limits);
        return result;
    }

    void leave(const std::set<int>& lost, const FarmLimits& limits) {
        orderly_ = dismiss_workers(*channels_[0], lost, limits.dismiss);
        for (std::thread& thread : threads_)
            thread.join();
        threads_.clear();
    }

    /// The result of one undisturbed worker with one thread.
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
        EXPECT_EQ(hash_text(result.aov_hash), hash_text(truth().aov_hash));
        EXPECT_EQ(hash_text(result.tree_hash), hash_text(truth().tree_hash));
        EXPECT_EQ(result.spp, 100u);
        ASSERT_EQ(result.passes.size(), truth().passes.size());
        for (std::size_t k = 0; k < result.passes.size(); ++k) {
            EXPECT_EQ(result.passes[k].stats.paths, truth().passes[k].stats.paths) << "pass " << k;
            EXPECT_EQ(result.passes[k].stats.records, truth().passes[k].stats.records) << "pass " << k;
            EXPECT_EQ(result.passes[k].tree.cells, truth().passes[k].tree.cells) << "pass " << k;
        }
    }

    Resolved job_ = resolve(test_job(), SceneFacts{});
    std::function<void(PassPlan&)> change_pass_;  ///< of each pass that the job asks for
    PassHooks hooks_;
    /// The worker that has work before the others begin: a fault of it comes to pass however slowly threads start.
    std::optional<std::size_t> first_;
    std::optional<RenderState> resumed_;  ///< taken: what the render goes on from
    JobTurn turn_;
    bool stay_ = false;              ///< workers, for another render()
    std::atomic<bool> sent_{false};  ///< a first result (on_first_result)
    std::vector<std::unique_ptr<Channel>> channels_;
    std::vector<std::unique_ptr<FaultyChannel>> faulty_;
    std::vector<WorkerSettings> settings_;
    std::vector<MakeRenderer> renderers_;
    std::vector<WorkerEnd> ends_;
    std::vector<std::thread> threads_;
    std::uint64_t reissued_ = 0, copied_ = 0, dropped_ = 0, bad_messages_ = 0;
    std::set<int> lost_;
    bool orderly_ = false;
};

}  // namespace treefarm::test
