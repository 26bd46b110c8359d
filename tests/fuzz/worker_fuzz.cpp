// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <deque>

#include "common/base/hash.h"
#include "common/guiding/sd_tree/sd_tree.h"
#include "common/scene/pack/scene_codec.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/message_script.h"
#include "tests/support/fake_work.h"
#include "worker/worker_loop.h"

// A worker among rogues: its coordinator and two other workers say any well-formed nonsense, in any order. Whatever
// they say, the worker goes on until it is told to leave, and what it sends has a bound.

using namespace treefarm;

namespace {

constexpr int kPeers = 4, kSelf = 1;
constexpr std::uint32_t kSize = 12;
const Bytes kScene = encode_scene(Scene());

void require(bool condition, const char* what) {
    if (condition) return;
    std::fprintf(stderr, "%s\n", what);
    std::abort();
}

fuzz::Known what_rogues_know() {
    fuzz::Known known;
    known.tree = encode_tree(initial_tree(Box3(Vec3(0.0f), Vec3(1.0f)), 1.0f));
    known.tree_bytes = known.tree.size();
    known.tree_hash = hash_bytes(known.tree);
    known.scene = kScene;
    known.scene_bytes = kScene.size();
    known.scene_hash = hash_bytes(kScene);
    known.width = known.height = static_cast<int>(kSize);
    return known;
}

/// A channel that says what the script does, a message at a look; a good start first, so that nonsense meets a worker
/// at work, and in the end the word to leave.
class ScriptedChannel final : public Channel {
  public:
    explicit ScriptedChannel(std::span<const std::uint8_t> input) : script_(input), known_(what_rogues_know()) {
        if (script_.one_in(3)) return;
        say(Welcome{1, 0.5, "", known_.scene_hash, known_.scene_bytes, false});
        say(Chunk{Blob::scene, 0, 0, kScene.size(), 0, {}, kScene});
        PassBegin begin;
        begin.plan = {.index = 0, .spp = 2, .record = true};
        begin.tree_bytes = known_.tree_bytes;
        begin.tree_hash = known_.tree_hash;
        say(begin);
        say(Chunk{Blob::tree, 0, 0, known_.tree.size(), 0, {}, known_.tree});
        say(Work{0, {{0, 0, 0, 4, 4, 0}, {0, 4, 0, 8, 4, 0}}});
    }

    int self() const override { return kSelf; }
    int peer_count() const override { return kPeers; }
    void send(int peer, Payload payload) override {
        require(peer >= 0 && peer < kPeers && peer != kSelf, "a message to nobody");
        (void)decode(*payload);
        sent_ += payload->size();
        ++messages_sent_;
    }
    std::optional<Received> poll() override {
        if (std::exchange(looked_, !looked_)) return std::nullopt;  // between messages the worker does what it can
        ++messages_;
        if (!start_.empty()) {
            Received next = std::move(start_.front());
            start_.pop_front();
            return next;
        }
        if (script_.done()) return Received{0, encode(Leave{false})};
        const int peers[] = {0, 2, 3};
        const int peer = peers[script_.below(3)];
        Bytes bytes = fuzz::any_message(script_, known_);
        if (peer == 0 && open_envelope(bytes).kind == Kind::leave) bytes = encode(Heartbeat{});
        return Received{peer, std::move(bytes)};
    }
    bool drained() override { return true; }
    void rest(double) override {}
    std::uint64_t bytes_sent() const override { return sent_; }
    std::uint64_t bytes_received() const override { return 0; }

    std::uint64_t messages() const { return messages_; }
    std::uint64_t messages_sent() const { return messages_sent_; }

  private:
    template <class M>
    void say(const M& message) {
        start_.push_back({0, encode(message)});
    }

    fuzz::Script script_;
    const fuzz::Known known_;
    std::deque<Received> start_;
    bool looked_ = false;
    std::uint64_t sent_ = 0, messages_ = 0, messages_sent_ = 0;
};

RenderUnit make_renderer(const Scene&, const Resolved& job) {
    return [render = test::fake_renderer(job.sampler.seed, kSize)](const PassPlan& pass, const AnySampler& guide,
                                                                   const WorkUnit& unit, auto&... out) {
        const std::uint64_t paths = std::uint64_t{pass.units.light_paths} * pass.layers.splats.pixels;
        if (unit.x1 > kSize || unit.y1 > kSize || unit.kind == UnitKind::chains ||
            (unit.kind == UnitKind::light_paths && (unit.first >= paths || unit.count > paths - unit.first)))
            throw RunError("a work unit that does not fit the film");
        render(pass, guide, unit, out...);
    };
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    ScriptedChannel channel({data, size});
    const Log log = std::make_shared<spdlog::logger>("fuzz");
    const WorkerSettings settings{1, "here", 7, 1e9};
    const WorkerEnd end = run_worker(channel, settings, make_renderer, log);
    require(end == WorkerEnd::disorderly, "it left without being told");
    require(channel.messages_sent() < 20 * (channel.messages() + 10), "it says more than it is told");
    require(channel.bytes_sent() < 20'000 * (channel.messages() + 10), "what goes out has no bound");
    return 0;
}

std::vector<std::string> fuzz::seeds() {
    std::vector<std::string> seeds;
    for (int first = 0; first < 45; ++first) {
        std::string seed;
        for (int k = 0; k < 90; ++k)
            seed += static_cast<char>(k % 2 == 0 ? first * 7 + k * 31 : first + k * k * 13);
        seeds.push_back(seed);
    }
    return seeds;
}
