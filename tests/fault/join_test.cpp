// SPDX-License-Identifier: Apache-2.0
#include "common/comm/multi_channel.h"
#include "tests/fault/farm_fixture.h"

// Workers that join over TCP, beside those that were there from the start: the bits are the same whoever comes, goes,
// lies or dies.

namespace treefarm::test {
namespace {

class JoinTest : public FarmTest {
  protected:
    /// As make_workers(), with a coordinator that takes guests.
    void open(int workers) {
        make_workers(workers);
        base_ = std::move(channels_[0]);
        auto multi = std::make_unique<MultiChannel>(*base_);
        GuestOptions options;
        options.fingerprint = kFingerprint;
        ticket_ = multi->take_guests(options);
        channels_[0] = std::move(multi);
    }

    ~JoinTest() override {
        stop_ = true;
        for (std::thread& guest : guests_)
            guest.join();
    }

    /// A guest that joins, and says what `outgoing` makes of its messages; false: it dies instead of sending it.
    void start_guest(FaultyChannel::Filter outgoing = {}, MakeRenderer renderer = make_fake()) {
        guest_ends_.emplace_back();
        guests_.emplace_back([this, outgoing, renderer, &end = guest_ends_.back()] {
            std::unique_ptr<Channel> channel;
            while (!channel && !stop_)
                try {
                    channel = join_run(ticket_, kFingerprint);
                } catch (const InputError&) {
                }
            if (!channel) return;
            FaultyChannel faulty(*channel);
            struct Death {};
            if (outgoing) faulty.outgoing = [&](Bytes& bytes) { return outgoing(bytes) ? true : throw Death(); };
            try {
                end = run_worker(faulty, {2, "guest", kFingerprint, 60.0}, renderer, quiet_log());
            } catch (const Death&) {  // the connection closes
            }
        });
    }

    RenderResult render_and_close() {
        RenderResult result = render();
        static_cast<MultiChannel&>(*channels_[0]).close();
        for (std::thread& guest : guests_)
            guest.join();
        guests_.clear();
        return result;
    }

    std::unique_ptr<Channel> base_;
    JoinTicket ticket_;
    std::atomic<bool> stop_{false};
    std::vector<std::thread> guests_;
    std::deque<std::optional<WorkerEnd>> guest_ends_;
};

/// Whether every one of `flags` is up.
MakeRenderer make_waiting_for(std::atomic<int>& count, int enough) {
    return [&count, enough](const Scene&, const Resolved& job) -> RenderUnit {
        return [&count, enough, render = fake_renderer(job)](auto&... args) {
            for (int k = 0; k < 20'000 && count < enough; ++k)
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
            render(args...);
        };
    };
}

FaultyChannel::Filter counts_results(std::atomic<int>& count) {
    return [&count, sent = false](Bytes& bytes) mutable {
        if (is<Result>(bytes) && !std::exchange(sent, true)) ++count;
        return true;
    };
}

TEST_F(JoinTest, GuestsTakePartAndTheBitsAreThoseOfOne) {
    open(1);
    std::atomic<int> results = 0;
    renderers_[0] = make_waiting_for(results, 2);  // until both have brought something
    start_guest(counts_results(results));
    start_guest(counts_results(results));
    expect_truth(render_and_close());
    EXPECT_EQ(results, 2);
    for (const auto& end : guest_ends_)
        EXPECT_EQ(end, WorkerEnd::orderly);
    EXPECT_TRUE(orderly_);
    EXPECT_TRUE(lost_.empty());
    EXPECT_EQ(bad_messages_, 0u);
}

TEST_F(JoinTest, OneThatDiesWithWorkCostsTimeNotBits) {
    open(1);
    std::atomic<bool> died = false;
    renderers_[0] = make_patient(died);
    start_guest([&](Bytes& bytes) {
        if (is<Result>(bytes)) died = true;
        return !died;
    });
    // Nobody is silent for long enough: that the connection closed has to do.
    job_.farm.heartbeat_seconds = 10;
    expect_truth(render_and_close());
    EXPECT_TRUE(died);
    EXPECT_EQ(lost_, std::set<int>{2});
    EXPECT_GT(reissued_, 0u);
    EXPECT_TRUE(orderly_) << "MPI can still be shut down in order";
}

TEST_F(JoinTest, TheOnlyWorkerMayDieWhereOthersMayJoin) {
    open(1);
    std::atomic<bool> sent = false;
    faulty_[0]->outgoing = [&](Bytes& bytes) {
        if (is<Result>(bytes) && !sent.exchange(true)) bytes[0] ^= 1;  // and is barred
        return true;
    };
    hooks_.on_progress = [&](const RenderProgress&) {
        if (sent && guests_.empty()) start_guest();
    };
    expect_truth(render_and_close());
    EXPECT_EQ(bad_messages_, 1u);
    EXPECT_NE(guest_ends_.at(0), WorkerEnd::orphaned) << "it is sent away, in order if the barred one is heard in time";
}

TEST_F(JoinTest, AGuestThatOnlyClaimsProgressHoldsNobodyUp) {
    open(1);
    std::atomic<bool> has_work = false;
    renderers_[0] = make_patient(has_work);
    start_guest([&, samples = std::uint64_t{0}](Bytes& bytes) mutable {
        if (is<Heartbeat>(bytes)) {
            bytes = encode(Heartbeat{std::get<Heartbeat>(decode(bytes)).incarnation, samples += 1'000'000, samples});
            return true;
        }
        if (!is<Result>(bytes)) return true;
        has_work = true;
        bytes = encode(Heartbeat{std::get<Result>(decode(bytes)).incarnation, samples, samples});
        return true;
    });
    expect_truth(render_and_close());
    EXPECT_TRUE(has_work);
    EXPECT_GT(copied_, 0u);
    EXPECT_TRUE(lost_.empty());
}

TEST_F(JoinTest, OneThatSendsABadResultIsBarred) {
    open(1);
    std::atomic<bool> sent_bad_result = false;
    renderers_[0] = make_patient(sent_bad_result);
    start_guest([&](Bytes& bytes) {
        if (!is<Result>(bytes) || sent_bad_result.exchange(true)) return true;
        auto result = std::get<Result>(decode(bytes));
        result.units[0].pixels[0].half[0].mean.x = -1;
        bytes = encode(result);
        return true;
    });
    expect_truth(render_and_close());
    EXPECT_EQ(bad_messages_, 1u);
    EXPECT_EQ(lost_, std::set<int>{2});
}

/// Whatever guests say of themselves while ranks gather, they alone are refused, and the ranks are waited for.
TEST_F(JoinTest, GuestsThatAreRefusedWhileRanksGatherRefuseNobodyElse) {
    open(2);
    stay_ = false;
    for (int k = 0; k < 3; ++k)
        start_guest([k](Bytes& bytes) {
            if (!is<Hello>(bytes)) return true;
            auto hello = std::get<Hello>(decode(bytes));
            k == 0 ? void(hello.memory = 1) : k == 1 ? void(hello.threads = 0) : void(hello.fingerprint = 1);
            bytes = encode(hello);
            return true;
        });
    std::thread late([this] {
        std::this_thread::sleep_for(std::chrono::milliseconds(500));
        for (std::size_t w = 0; w < 2; ++w)
            start_worker(w);
    });
    Farm farm(*channels_[0], job_, kScene, kFingerprint, quiet_log());
    farm.require_of_guests(1000);
    farm.gather([] { return false; });
    late.join();
    EXPECT_EQ(farm.roster().present_count(), 2u);
    const SdTree tree = initial_tree(Box3(Vec3(0.0f), Vec3(1.0f)), 1.0f);
    const RenderResult result = run_passes(farm, job_, passes_of(job_), tree, kWidth, kHeight, {});
    for (const auto& [peer, member] : farm.roster().members())
        if (member.is_guest) {
            EXPECT_EQ(member.state, MemberState::refused) << peer;
        }
    stop_ = true;
    leave(farm.lost_peers(), {.dismiss = 20});
    static_cast<MultiChannel&>(*channels_[0]).close();
    expect_truth(result);
}

TEST_F(JoinTest, GuestsStayForTheNextJobAndComeInTheMiddleOfASeries) {
    open(1);
    stay_ = true;
    turn_.number = 1;
    std::atomic<int> first = 0, second = 0;
    renderers_[0] = make_waiting_for(first, 1);
    start_guest([&](Bytes& bytes) {
        if (is<Result>(bytes)) ++(turn_.number == 1 ? first : second);
        return true;
    });
    expect_truth(render());
    EXPECT_GT(first, 0);
    // The next worker's renderer is made anew for another job.
    turn_.number = 2;
    job_.guiding.spp_unit = 4;
    std::atomic<int> newcomer = 0;
    start_guest([&](Bytes& bytes) {
        if (is<Result>(bytes)) ++newcomer;
        return true;
    });
    stay_ = false;
    expect_truth(render_and_close());
    for (const auto& end : guest_ends_)
        EXPECT_EQ(end, WorkerEnd::orderly);
}

}  // namespace
}  // namespace treefarm::test
