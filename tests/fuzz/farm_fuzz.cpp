// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <deque>
#include <map>

#include "coordinator/farm/farm.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/message_script.h"
#include "tests/support/fake_work.h"

// The coordinator among rogues: three peers say any well-formed nonsense, a fourth works. Whatever they say, nothing
// throws, what goes out is bounded by what came in, and film and tree sums are those of the worker alone.

using namespace treefarm;

namespace {

constexpr int kRogues = 3, kWorker = 4, kPasses = 2;
constexpr int kSize = 12;
const Bytes kScene(100'000, 1);
constexpr std::uint64_t kBuild = 7;

Job fuzz_job() {
    Job job;
    job.farm.tile_size = 4;
    job.farm.heartbeat_seconds = 1000;  // so that nothing depends on the clock
    return job;
}

PassPlan pass_plan(std::uint32_t index) {
    PassPlan plan{.index = index, .spp = 2, .first_sample = 2 * index, .record = true};
    if (index == 0) return plan;
    plan.units.light_paths = 2;
    plan.layers.splats = {kSize * kSize, -8};
    return plan;
}

/// Peers 1 to 3 put in what the script says; peer 4 answers as a worker does, at once.
class ScriptedChannel final : public Channel {
  public:
    int self() const override { return 0; }
    int peer_count() const override { return kWorker + 1; }
    void send(int peer, Payload payload) override {
        sent_ += payload->size();
        if (peer == kWorker)
            answer(decode(*payload));
        else
            learn(known[peer], decode(*payload));
    }
    std::optional<Received> poll() override {
        if (inbox.empty()) return std::nullopt;
        Received next = std::move(inbox.front());
        inbox.pop_front();
        received_ += next.bytes.size();
        return next;
    }
    bool drained() override { return true; }
    void rest(double) override {}
    std::uint64_t bytes_sent() const override { return sent_; }
    std::uint64_t bytes_received() const override { return received_; }

    /// The worker has heard nothing of the tree for too long.
    void complain() {
        if (begin_.tree_bytes != tree_.size()) say(Resend{Blob::tree, 0, begin_.plan.index, tree_.size()});
    }

    std::deque<Received> inbox;
    std::map<int, fuzz::Known> known;

  private:
    void learn(fuzz::Known& rogue, const Message& message) {
        if (const auto* begin = std::get_if<PassBegin>(&message)) {
            rogue.pass = begin->plan.index;
            rogue.units.clear();
        } else if (const auto* work = std::get_if<Work>(&message)) {
            rogue.units.insert(rogue.units.end(), work->units.begin(), work->units.end());
        }
    }

    void answer(const Message& message) {
        if (const auto* begin = std::get_if<PassBegin>(&message)) {
            begin_ = *begin;
            tree_.clear();
        } else if (const auto* chunk = std::get_if<Chunk>(&message); chunk && chunk->blob == Blob::tree) {
            if (chunk->offset != tree_.size()) return;
            tree_.insert(tree_.end(), chunk->bytes.begin(), chunk->bytes.end());
            if (tree_.size() == chunk->total) say(Want{9, begin_.plan.index, 4});
        } else if (const auto* work = std::get_if<Work>(&message); work && !work->units.empty()) {
            Result result = test::fake_result(begin_.plan, tree_, work->units, kSize);
            result.incarnation = 9;
            say(result);
            say(Want{9, begin_.plan.index, static_cast<std::uint32_t>(work->units.size())});
        }
    }

    template <class M>
    void say(const M& message) {
        inbox.push_back({kWorker, encode(message)});
    }

    PassBegin begin_;
    Bytes tree_;
    std::uint64_t sent_ = 0, received_ = 0;
};

struct Outcome {
    std::vector<PixelEstimate> pixels;
    std::vector<Bytes> sums;
};

void require(bool condition, const char* what) {
    if (condition) return;
    std::fprintf(stderr, "%s\n", what);
    std::abort();
}

fuzz::Known what_a_rogue_knows(int peer) {
    fuzz::Known known;
    known.incarnation = static_cast<std::uint64_t>(peer);
    known.fingerprint = kBuild;
    known.scene_hash = 1;
    known.scene = known.tree = Bytes(10);
    known.width = known.height = kSize;
    return known;
}

Outcome run(std::span<const std::uint8_t> input) {
    fuzz::Script script(input);
    ScriptedChannel channel;
    const Log log = std::make_shared<spdlog::logger>("fuzz");
    Farm farm(channel, fuzz_job(), kScene, kBuild, log, {.gather = 0, .lost = 1e9, .asking = 0});
    for (int peer = 1; peer <= kRogues; ++peer)
        channel.known[peer] = what_a_rogue_knows(peer);
    channel.inbox.push_back({kWorker, encode(Hello{9, kBuild, 2, 0, 0, 0, "here", "0"})});
    farm.step();
    std::uint64_t messages = 0;
    const auto rogues_speak = [&](std::uint32_t most) {
        for (std::uint32_t k = 0; k < most && !script.done(); ++k) {
            const int peer = 1 + static_cast<int>(script.below(kRogues));
            channel.inbox.push_back({peer, fuzz::any_message(script, channel.known[peer])});
            ++messages;
            if (!farm.pass_complete()) farm.step();
        }
    };
    rogues_speak(10);
    farm.gather([] { return false; });
    const SdTree tree = initial_tree(Box3(Vec3(0.0f), Vec3(1.0f)), 1.0f);
    Outcome outcome;
    for (std::uint32_t pass = 0; pass < kPasses; ++pass) {
        farm.begin_pass(pass_plan(pass), tree, encode_tree(tree), kSize, kSize);
        rogues_speak(20);
        // Who holds work and never delivers it is a matter of the clock, not of messages: they leave.
        for (int peer = 1; peer <= kRogues; ++peer)
            channel.inbox.push_back({peer, Bytes{1, 2, 3}});
        channel.complain();  // a rogue before it in the chain does not pass anything on
        for (int step = 0; step < 1000 && !farm.pass_complete(); ++step)
            farm.step();
        require(farm.pass_complete(), "the pass did not end");
        const std::vector<PixelEstimate> pixels = farm.take_pixels();
        outcome.pixels.insert(outcome.pixels.end(), pixels.begin(), pixels.end());
        outcome.sums.push_back(farm.collector().evidence().encode());
    }
    require(channel.bytes_sent() < 8 * kScene.size() + 1000 * (messages + 100), "what goes out has no bound");
    return outcome;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const Outcome truth = run({});
    const Outcome outcome = run({data, size});
    require(outcome.sums == truth.sums, "the tree sums hold what was refused");
    require(outcome.pixels.size() == truth.pixels.size(), "pixels are missing");
    for (std::size_t p = 0; p < truth.pixels.size(); ++p)
        for (int half = 0; half < 2; ++half) {
            const Moments &is = outcome.pixels[p].half[half], &should = truth.pixels[p].half[half];
            require(is.n == should.n && is.mean == should.mean && is.m2 == should.m2,
                    "the image holds what was refused");
        }
    return 0;
}

std::vector<std::string> fuzz::seeds() {
    std::vector<std::string> seeds;
    for (int first = 0; first < 45; ++first) {  // each kind from each peer, with some of everything behind it
        std::string seed;
        for (int k = 0; k < 120; ++k)
            seed += static_cast<char>(k % 2 == 0 ? first * 7 + k * 31 : first + k * k * 13);
        seeds.push_back(seed);
    }
    return seeds;
}
