// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include "common/config/job_reader.h"
#include "tests/fault/farm_fixture.h"

// A peer that says what it must not: it loses its place, and nothing else is different.

namespace treefarm::test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct BadResult {
    const char* name;
    std::function<void(Result&)> tell;
};

std::ostream& operator<<(std::ostream& out, const BadResult& bad) {
    return out << bad.name;
}

Moments& moments(Result& r) {
    return r.units.back().pixels.back().half[0];
}

/// Replaces a number of encoded evidence, which consists of varints.
void change_varint(Bytes& evidence, int number) {
    ByteReader in(evidence);
    ByteWriter out;
    for (int k = 0; k < number; ++k)
        out.put_varint(in.get_varint());
    in.get_varint();
    out.put_varint(~std::uint64_t{0});
    out.put_bytes(in.get_bytes(in.remaining()));
    evidence = out.take();
}

/// Index of the first number of recorded vertices in evidence of decisions that counted nothing.
int first_vertices(const Bytes& evidence) {
    ByteReader in(evidence);
    int numbers = 0;
    const auto next = [&] {
        ++numbers;
        return in.get_varint();
    };
    const auto skip_block = [&] {
        next();  // rows
        for (std::uint64_t entries = next(); entries > 0; --entries) {
            next();
            next();
        }
    };
    next();  // pass
    for (std::size_t decision = 0; decision < std::tuple_size_v<decltype(Decisions::Evidence::all)>; ++decision)
        skip_block();
    skip_block();  // cells
    next();
    next();
    next();
    return numbers;
}

class ResultThatCannotBe : public FarmTest, public ::testing::WithParamInterface<BadResult> {};

TEST_P(ResultThatCannotBe, ExcludesTheWorkerAndIsCounted) {
    change_first_result(GetParam().tell);
    expect_truth(render());
    EXPECT_EQ(lost_, std::set<int>{1});
    EXPECT_EQ(bad_messages_, 1u);
}

INSTANTIATE_TEST_SUITE_P(
    Lies, ResultThatCannotBe,
    ::testing::Values(
        BadResult{"a mean that is no number", [](Result& r) { moments(r).mean.x = kNan; }},
        BadResult{"an infinite mean", [](Result& r) { moments(r).mean.y = kInfinity; }},
        BadResult{"a negative mean", [](Result& r) { moments(r).mean.z = -1e-6; }},
        BadResult{"deviations that are no number", [](Result& r) { moments(r).m2.y = kNan; }},
        BadResult{"negative deviations", [](Result& r) { moments(r).m2.x = -1; }},
        BadResult{"samples in the wrong half",
                  [](Result& r) {
                      for (auto* pixels : {&r.units[0].pixels, &r.units[0].aovs.direct})
                          for (PixelEstimate& pixel : *pixels) {
                              pixel.half[0].n += pixel.half[1].n;
                              pixel.half[1].n = 0;
                          }
                  }},
        BadResult{"an AOV that is no number", [](Result& r) { r.units.back().aovs.values.back() = kNan; }},
        BadResult{"an AOV less", [](Result& r) { r.units.back().aovs.values.pop_back(); }},
        BadResult{"no direct light", [](Result& r) { r.units[0].aovs.direct.clear(); }},
        BadResult{"infinite direct light", [](Result& r) { r.units[0].aovs.direct[0].half[1].mean.x = kInfinity; }},
        BadResult{"seconds that are no number", [](Result& r) { r.stats.trace_seconds = kNan; }},
        BadResult{"negative seconds", [](Result& r) { r.stats.splat_seconds = -1; }},
        BadResult{"endless seconds", [](Result& r) { r.stats.phase_seconds[2] = kInfinity; }},
        BadResult{"more paths than were asked for", [](Result& r) { ++r.stats.paths; }},
        BadResult{"more paths with light than paths", [](Result& r) { r.stats.nonzero_paths = r.stats.paths + 1; }},
        BadResult{"an invalid sample outside the film",
                  [](Result& r) {
                      r.stats.first_invalid.push_back({r.pass, 60000, 0, 0, {0, 0, 0}});
                  }},
        BadResult{"thousands of invalid samples",
                  [](Result& r) {
                      r.stats.first_invalid.resize(5000, {r.pass, 0, 0, 0, {0, 0, 0}});
                  }},
        BadResult{"noise that is no number",
                  [](Result& r) {
                      r.stats.tails.worst = {{kNan, r.pass, 0, 0, 0, {}}};
                  }},
        BadResult{"no noise",
                  [](Result& r) {
                      r.stats.tails.worst = {{0, r.pass, 0, 0, 0, {}}};
                  }},
        BadResult{"a noisy sample outside the film",
                  [](Result& r) {
                      r.stats.tails.worst = {{1, r.pass, 0, 60000, 0, {}}};
                  }},
        BadResult{"a noisy sample of another pass",
                  [](Result& r) {
                      r.stats.tails.worst = {{1, r.pass + 1, 0, 0, 0, {}}};
                  }},
        BadResult{"noisy samples in disorder",
                  [](Result& r) {
                      r.stats.tails.worst = {{1, r.pass, 0, 0, 0, {}}, {2, r.pass, 0, 0, 0, {}}};
                  }},
        BadResult{"too many noisy samples",
                  [](Result& r) {
                      r.stats.tails.worst.assign(9, {1, r.pass, 0, 0, 0, {}});
                  }},
        BadResult{"a mean that no float holds", [](Result& r) { moments(r).mean.x = 1e308; }},
        BadResult{"a mean near the end of floats", [](Result& r) { moments(r).mean.x = 3e38; }},
        BadResult{"deviations that no square has", [](Result& r) { moments(r).m2.x = 1e308; }},
        BadResult{"an AOV that no float holds", [](Result& r) { r.units[0].aovs.values[0] = -1e59; }},
        BadResult{"direct light that no float holds",
                  [](Result& r) { r.units[0].aovs.direct[0].half[0].mean.x = 1e40; }},
        BadResult{"negative direct light", [](Result& r) { r.units[0].aovs.direct[0].half[0].mean.x = -1; }},
        BadResult{"deviations of direct light that no square has",
                  [](Result& r) { r.units[0].aovs.direct[0].half[0].m2.x = 1e308; }},
        BadResult{"more rays than anybody traces", [](Result& r) { r.stats.rays = ~std::uint64_t{0}; }},
        BadResult{"more shadow rays than anybody traces", [](Result& r) { r.stats.shadow_rays = 1ull << 60; }},
        BadResult{"more rays of split paths than rays", [](Result& r) { r.stats.split_path_rays = r.stats.rays + 1; }},
        BadResult{"more seconds than have passed", [](Result& r) { r.stats.trace_seconds = 1e6; }},
        BadResult{"busy for longer than has passed", [](Result& r) { r.stats.busy_seconds = 1e9; }},
        BadResult{"more seconds of a phase than have passed", [](Result& r) { r.stats.phase_seconds[1] = 1e6; }},
        BadResult{"evidence of another pass", [](Result& r) { change_varint(r.evidence, 0); }},
        BadResult{"evidence with more rows than it has", [](Result& r) { change_varint(r.evidence, 1); }},
        BadResult{"evidence that is cut short", [](Result& r) { r.evidence.pop_back(); }},
        BadResult{"more records of a region than anybody makes",
                  [](Result& r) { change_varint(r.evidence, first_vertices(r.evidence)); }},
        BadResult{"work of another pass", [](Result& r) { r.pass += 1; }}),
    [](const auto& info) { return "Lie" + std::to_string(info.index); });

/// A checkpoint may hold what no worker may send, and a render must not end well with it.
TEST_F(FarmTest, AnImageThatNoFloatHoldsIsAFailure) {
    for (const double huge : {1e45, 1e200}) {
        faulty_.clear();
        make_workers(1);
        bool begun = false;
        RenderState state = first_state(job_, initial_tree(Box3(Vec3(0.0f), Vec3(1.0f)), 1.0f), kWidth * kHeight);
        hooks_.on_state = [&](RenderState&) { begun = true; };
        hooks_.interrupted = [&] { return begun; };
        hooks_.on_last_state = [&](RenderState last) { state = std::move(last); };
        EXPECT_TRUE(render().interrupted);
        ASSERT_FALSE(state.films.empty());
        for (Moments& half : state.films[0].pixels[7].half)
            half.mean.y = huge;
        hooks_ = {};
        faulty_.clear();
        make_workers(1);
        resumed_ = std::move(state);
        EXPECT_THROW(render(), RunError) << huge;
    }
}

/// Messages that a rogue may send to anybody at any time: well-formed, and none of its business.
std::vector<Bytes> orders() {
    PassBegin pass;
    pass.plan = {.index = 99, .spp = 4, .record = true};
    pass.tree_bytes = 5;
    return {encode(Leave{false}),
            encode(Quit{}),
            encode(Rejoin{0}),
            encode(Rejoin{7}),
            encode(Work{0, {{0, 60000, 60000, 60001, 60001, 9}}}),
            encode(pass),
            encode(Refuse{"go away"}),
            encode(Welcome{1, 1e5, "farm.heartbeat_seconds = 3000\n", 9, 9, false}),
            Bytes{1, 2, 3}};
}

TEST_F(FarmTest, WorkersTakeOrdersFromTheCoordinatorAlone) {
    make_workers(3);
    first_ = 2;
    std::atomic<int> times = 0;
    faulty_[2]->outgoing = [&](Bytes& bytes) {
        if ((is<Want>(bytes) || is<Result>(bytes)) && times++ < 20)
            for (const Bytes& order : orders())
                for (const int peer : {1, 2})
                    channels_[3]->send(peer, std::make_shared<const Bytes>(order));
        return true;
    };
    expect_truth(render());
    EXPECT_GT(times, 2);
    EXPECT_TRUE(lost_.empty());
    EXPECT_TRUE(orderly_);
    for (const WorkerEnd end : ends_)
        EXPECT_EQ(end, WorkerEnd::orderly);
}

TEST_F(FarmTest, OrdersToTheCoordinatorExcludeTheirSender) {
    for (const Bytes& order : orders()) {
        channels_.clear();
        faulty_.clear();
        make_workers(2);
        std::atomic<bool> sent = false;
        renderers_[1] = make_patient(sent);
        faulty_[0]->outgoing = [&](Bytes& bytes) {
            if (is<Want>(bytes) && !sent.exchange(true)) channels_[1]->send(0, std::make_shared<const Bytes>(order));
            return true;
        };
        expect_truth(render());
        EXPECT_EQ(lost_, std::set<int>{1});
        EXPECT_EQ(bad_messages_, 1u);
    }
}

/// Threads are summed over workers.
TEST_F(FarmTest, HellosThatOverflowASumAreHarmless) {
    for (const std::uint32_t threads : {0xffffffffu, 0x80000000u, kMostThreads}) {
        channels_.clear();
        faulty_.clear();
        make_workers(3);
        int hellos = 0;
        faulty_[0]->outgoing = faulty_[1]->outgoing = [&](Bytes& bytes) {
            if (!is<Hello>(bytes)) return true;
            auto hello = std::get<Hello>(decode(bytes));
            hello.threads = threads;
            bytes = encode(hello);
            ++hellos;
            return true;
        };
        expect_truth(render({.gather = 0.5, .lost = 20, .dismiss = 20}));
        EXPECT_GE(hellos, 2);
    }
}

TEST_F(FarmTest, AWorkerWithEndlessWishesGetsItsShare) {
    make_workers(2);
    faulty_[0]->outgoing = [&](Bytes& bytes) {
        if (!is<Want>(bytes)) return true;
        auto want = std::get<Want>(decode(bytes));
        want.units = 0xffffffff;
        bytes = encode(want);
        channels_[1]->send(0, std::make_shared<const Bytes>(bytes));
        return true;
    };
    expect_truth(render());
    EXPECT_TRUE(lost_.empty());
}

TEST_F(FarmTest, ATreeThatIsChangedOnItsWayIsAskedForAgain) {
    make_workers(3);
    std::atomic<int> changed = 0;
    faulty_[0]->outgoing = [&](Bytes& bytes) {  // the head of the chain, to the one behind it
        if (!is<Chunk>(bytes)) return true;
        auto chunk = std::get<Chunk>(decode(bytes));
        chunk.bytes[chunk.bytes.size() / 2] ^= 1;
        bytes = encode(chunk);
        ++changed;
        return true;
    };
    expect_truth(render());
    EXPECT_GT(changed, 3);
    EXPECT_TRUE(lost_.empty());
    EXPECT_TRUE(orderly_);
}

TEST_F(FarmTest, AskingForTheSceneForEverTakesNoMemory) {
    make_workers(2);
    job_.farm.heartbeat_seconds = 0.2;
    std::atomic<int> asked = 0;
    std::atomic<std::size_t> received = 0;
    faulty_[0]->outgoing = [&](Bytes& bytes) {
        if (is<Want>(bytes) && asked == 0)
            for (; asked < 5000; ++asked)
                channels_[1]->send(0, std::make_shared<const Bytes>(encode(Resend{Blob::scene, 0, 0, 0})));
        return true;
    };
    faulty_[0]->incoming = [&](Bytes& bytes) {
        received += bytes.size();
        return true;
    };
    expect_truth(render());
    EXPECT_EQ(asked, 5000);
    EXPECT_LT(received, 20 * kScene.size());
}

TEST_F(FarmTest, AFloodOfMessagesDoesNotStopTheRender) {
    make_workers(2);
    std::atomic<bool> over = false;
    std::thread flood;
    faulty_[0]->outgoing = [&](Bytes& bytes) {
        if (is<Want>(bytes) && !flood.joinable())
            flood = std::thread([&, bytes] {
                const auto beat = std::make_shared<const Bytes>(encode(Heartbeat{1, 2, 3}));
                for (int k = 0; k < 2'000'000 && !over; ++k)
                    channels_[1]->send(0, beat);
            });
        return true;
    };
    expect_truth(render());
    over = true;
    flood.join();
}

/// Found by fuzz_worker: work of the pass before met threads that knew of no pass.
TEST_F(FarmTest, AWelcomeToAnotherJobEndsThePassOfTheOneBefore) {
    make_workers(1);
    start_worker(0);
    const auto say = [&](const auto& message) {
        channels_[0]->send(1, std::make_shared<const Bytes>(encode(message)));
    };
    const Bytes tree = encode_tree(initial_tree(Box3(Vec3(0.0f), Vec3(1.0f)), 1.0f));
    PassBegin begin;
    begin.plan = {.spp = 2, .record = true};
    begin.tree_bytes = tree.size();
    begin.tree_hash = hash_bytes(tree);
    say(Welcome{1, 0.5, write_job(job_), hash_bytes(kScene), kScene.size(), true});
    say(Chunk{Blob::scene, 0, 0, kScene.size(), 0, {}, kScene});
    say(begin);
    say(Chunk{Blob::tree, 0, 0, tree.size(), 0, {}, tree});
    const auto wants = [&] {
        const auto message = channels_[0]->poll();
        return message && is<Want>(message->bytes);
    };
    for (int k = 0; k < 20'000 && !wants(); ++k)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    job_.sampler.seed = 1;
    say(Welcome{1, 0.5, write_job(job_), hash_bytes(kScene), kScene.size(), true});
    for (int k = 0; k < 100; ++k) {
        say(Work{0, {{0, 0, 0, 4, 4, 0}}});
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    leave({}, {.dismiss = 20});
    EXPECT_TRUE(orderly_);
}

}  // namespace
}  // namespace treefarm::test
