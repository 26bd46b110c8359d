// SPDX-License-Identifier: Apache-2.0
#include "tests/fault/farm_fixture.h"

// Who hears from whom, and for how long nobody need be heard.

namespace treefarm::test {
namespace {

/// Faults that are only seen by silence: short limits.
constexpr FarmLimits kShortSilence{.gather = 20, .lost = 0.3, .dismiss = 20};

/// Sees what arrived during a pause only at its second look, as MPI over TCP may.
class DrowsyChannel final : public Channel {
  public:
    explicit DrowsyChannel(Channel& inner) : inner_(inner) {}
    bool asleep = false;

    int self() const override { return inner_.self(); }
    int peer_count() const override { return inner_.peer_count(); }
    void send(int peer, Payload payload) override { inner_.send(peer, std::move(payload)); }
    std::optional<Received> poll() override { return std::exchange(asleep, false) ? std::nullopt : inner_.poll(); }
    bool drained() override { return inner_.drained(); }
    void rest(double seconds) override { inner_.rest(seconds); }
    std::uint64_t bytes_sent() const override { return inner_.bytes_sent(); }
    std::uint64_t bytes_received() const override { return inner_.bytes_received(); }

  private:
    Channel& inner_;
};

TEST_F(FarmTest, WhenAllAreSilentForAWhileTheFarmWaitsForThem) {
    make_workers(2);
    std::atomic<bool> dark = false;
    std::thread mend;
    int results = 0;
    const auto darken = [&](Bytes& bytes) {
        if (is<Result>(bytes) && ++results == 2) {
            dark = faulty_[0]->cut = faulty_[1]->cut = true;
            mend = std::thread([&] {
                std::this_thread::sleep_for(std::chrono::milliseconds(1200));  // four times the limit
                faulty_[0]->cut = faulty_[1]->cut = false;
            });
        }
        return true;
    };
    faulty_[0]->outgoing = darken;
    expect_truth(render(kShortSilence));
    mend.join();
    EXPECT_TRUE(lost_.empty()) << "they are back";
}

TEST_F(FarmTest, WhenNobodyComesBackTheRunEnds) {
    make_workers(2);
    for (WorkerSettings& settings : settings_)
        settings.silence_seconds = 1.0;
    int results = 0;
    faulty_[0]->outgoing = [&](Bytes& bytes) {
        if (is<Result>(bytes) && ++results == 2) faulty_[0]->cut = faulty_[1]->cut = true;
        return true;
    };
    FarmLimits limits = kShortSilence;
    limits.grace = 0.5;
    EXPECT_THROW(render(limits), RunError);
}

/// Combining, refining and writing a large image may take longer than workers wait for a sign.
TEST_F(FarmTest, WorkersHearFromACoordinatorThatComputes) {
    make_workers(2);
    for (WorkerSettings& settings : settings_)
        settings.silence_seconds = 1.0;
    for (std::size_t w = 0; w < 2; ++w)
        start_worker(w);
    Farm farm(*channels_[0], job_, kScene, kFingerprint, quiet_log());
    farm.gather([] { return false; });
    farm.beat_during([] { std::this_thread::sleep_for(std::chrono::milliseconds(2500)); });
    EXPECT_THROW(farm.beat_during([] { throw RunError("what it computes may fail"); }), RunError);
    leave({}, {.dismiss = 20});
    EXPECT_TRUE(orderly_);
    for (const WorkerEnd end : ends_)
        EXPECT_EQ(end, WorkerEnd::orderly);
}

/// So may copying it for a checkpoint, and writing it at the end.
TEST_F(FarmTest, WorkersHearFromACoordinatorThatWrites) {
    make_workers(2);
    for (WorkerSettings& settings : settings_)
        settings.silence_seconds = 1.0;
    const auto write = [] { std::this_thread::sleep_for(std::chrono::milliseconds(2500)); };
    hooks_.on_state = [&](const RenderState& state) {
        if (state.reports.size() == 1) write();
    };
    hooks_.on_last_state = [&](const RenderState&) { write(); };
    expect_truth(render());
    EXPECT_TRUE(orderly_);
    for (const WorkerEnd end : ends_)
        EXPECT_EQ(end, WorkerEnd::orderly);
}

TEST_F(FarmTest, WorkersLeaveWhenTheCoordinatorFallsSilent) {
    make_workers(1);
    settings_[0].silence_seconds = 0.05;
    EXPECT_EQ(run_worker(*faulty_[0], settings_[0], renderers_[0], quiet_log()), WorkerEnd::orphaned);
}

TEST_F(FarmTest, AWorkerThatWasStoppedForAWhileStays) {
    make_workers(2);
    settings_[1].silence_seconds = 2;
    faulty_[1]->incoming = [&, passes = 0](Bytes& bytes) mutable {
        if (is<PassBegin>(bytes) && ++passes == 2) faulty_[1]->nap_ms = 2200;
        return true;
    };
    expect_truth(render());
    EXPECT_TRUE(orderly_);
    EXPECT_EQ(ends_[1], WorkerEnd::orderly);
}

TEST_F(FarmTest, ACoordinatorThatWasBusyGivesNobodyUp) {
    make_workers(2);
    for (std::size_t w = 0; w < 2; ++w)
        start_worker(w);
    DrowsyChannel channel(*channels_[0]);
    Farm farm(channel, job_, kScene, kFingerprint, quiet_log(), kShortSilence);
    farm.gather([] { return false; });
    PassHooks hooks;
    hooks.on_pass = [&](const PassReport& pass, const CombinedImage&) {
        if (pass.plan.index > 0) return;
        std::this_thread::sleep_for(std::chrono::milliseconds(500));  // longer than the limit
        channel.asleep = true;
    };
    const SdTree tree = initial_tree(Box3(Vec3(0.0f), Vec3(1.0f)), 1.0f);
    RenderResult result;
    try {
        result = run_passes(farm, job_, passes_of(job_), tree, kWidth, kHeight, hooks);
    } catch (const RunError& error) {
        ADD_FAILURE() << error.what();
    }
    leave({}, {.dismiss = 20});
    expect_truth(result);
    EXPECT_TRUE(farm.lost_peers().empty());
    EXPECT_EQ(farm.reissued_units(), 0u);
    EXPECT_TRUE(orderly_);
}

}  // namespace
}  // namespace treefarm::test
