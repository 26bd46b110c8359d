// SPDX-License-Identifier: Apache-2.0
#include "common/comm/tcp_channel.h"

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <thread>

#include "common/base/error.h"
#include "common/base/timer.h"
#include "common/comm/in_process_channel.h"
#include "common/comm/multi_channel.h"
#include "tests/unit/comm/raw_connection.h"

// A coordinator's door and guests over sockets of this machine. Time limits are by a clock of the test's own.

namespace treefarm {
namespace {

constexpr std::uint64_t kBuild = test::kGuestBuild;
using test::RawConnection;
constexpr int kFirst = 3;

Payload payload(std::size_t count, int salt = 0) {
    Bytes bytes(count);
    for (std::size_t k = 0; k < count; ++k)
        bytes[k] = static_cast<std::uint8_t>(k * 31 + k / 251 + static_cast<std::size_t>(salt));
    return std::make_shared<const Bytes>(std::move(bytes));
}

class TcpChannelTest : public ::testing::Test {
  protected:
    void open(const GuestLimits& limits = {}, const std::string& address = "127.0.0.1") {
        GuestOptions options;
        options.address = address;
        options.fingerprint = kBuild;
        options.warning = [this](const std::string& text) { warnings_.push_back(text); };
        listener_ = std::make_unique<TcpChannel>(options, kFirst, limits, [this] { return now_; });
    }

    /// Turns the door's loop until something is so.
    void turn_until(const std::function<bool()>& condition) {
        const Timer timer;
        while (!condition() && timer.seconds() < 30) {
            if (auto message = listener_->poll()) got_.push_back(std::move(*message));
            listener_->rest(1e-3);
        }
        EXPECT_TRUE(condition());
    }

    /// A guest that has come in with a message of four bytes.
    std::unique_ptr<Channel> guest() {
        std::unique_ptr<Channel> channel;
        std::thread joining([&] { channel = join_run(listener_->ticket(), kBuild); });
        turn_until([&] { return listener_->unproven() > 0; });
        const Timer timer;
        std::atomic<bool> joined = false;
        std::thread wait([&] {
            joining.join();
            joined = true;
        });
        while (!joined && timer.seconds() < 30)
            listener_->drained();
        wait.join();
        const std::size_t before = got_.size();
        channel->send(0, payload(4));
        turn_until([&] { return got_.size() > before; });
        return channel;
    }

    double now_ = 0;
    std::vector<std::string> warnings_;
    std::vector<Received> got_;
    std::unique_ptr<TcpChannel> listener_;
};

TEST_F(TcpChannelTest, MessagesOfAnySizeComeBothWaysInOrder) {
    for (const char* address : {"127.0.0.1", "::1"}) {
        got_.clear();
        try {
            open({}, address);
        } catch (const InputError& error) {
            GTEST_LOG_(INFO) << "no IPv6 here: " << error.what();
            continue;
        }
        const auto channel = guest();
        EXPECT_EQ(listener_->peers(), std::vector<int>{kFirst});
        const std::vector<std::size_t> sizes = {0, 1, 70'000, kMostFrameBytes + 1, 3};
        std::thread other([&] {
            for (const std::size_t size : sizes)
                channel->send(0, payload(size, 1));
            for (std::size_t k = 0; k < sizes.size();) {
                if (const auto message = channel->poll()) {
                    EXPECT_EQ(message->bytes, *payload(sizes[k++], 2));
                    EXPECT_EQ(message->peer, 0);
                } else {
                    channel->rest(1e-3);
                }
            }
            while (!channel->drained())  // it may have heard all before all was sent
                channel->rest(1e-3);
        });
        for (const std::size_t size : sizes)
            listener_->send(kFirst, payload(size, 2));
        turn_until([&] { return got_.size() == 1 + sizes.size() && listener_->drained(); });
        other.join();
        ASSERT_EQ(got_.size(), 1 + sizes.size());
        for (std::size_t k = 0; k < sizes.size(); ++k)
            EXPECT_EQ(got_[k + 1].bytes, *payload(sizes[k], 1)) << k;
        EXPECT_TRUE(warnings_.empty());
    }
}

TEST_F(TcpChannelTest, AGuestThatClosesIsGoneAtOnceAndItsNumberToo) {
    open();
    auto first = guest();
    first->send(0, payload(9));
    first.reset();
    turn_until([&] { return !listener_->is_open(kFirst); });
    EXPECT_EQ(got_.back().bytes, *payload(9)) << "its last words are heard";
    listener_->send(kFirst, payload(1));  // nobody hears it
    EXPECT_TRUE(listener_->drained());
    const auto second = guest();
    EXPECT_EQ(listener_->peers(), std::vector<int>{kFirst + 1});
    EXPECT_EQ(listener_->peer_count(), kFirst + 2);
    EXPECT_TRUE(warnings_.empty());
}

TEST_F(TcpChannelTest, AGuestNoticesThatTheCoordinatorIsGone) {
    open();
    auto channel = guest();
    listener_->send(kFirst, payload(5));
    EXPECT_TRUE(listener_->drained());
    std::thread closing([&] { listener_->close(0.1); });
    const Timer timer;
    bool heard = false;
    while (channel->is_open(0) && timer.seconds() < 30) {
        channel->send(0, payload(1));  // also fails one day: what was said before is heard all the same
        if (channel->poll()) heard = true;
        channel->rest(1e-3);
    }
    EXPECT_TRUE(heard);
    EXPECT_FALSE(channel->is_open(0));
    channel.reset();  // the other end waits for that
    closing.join();
}

TEST_F(TcpChannelTest, WhoIsWrongIsCutOffWithOneLineAndTheOthersGoOn) {
    open();
    const auto honest = guest();
    JoinTicket wrong = listener_->ticket();
    wrong.secret[0] ^= 1;
    RawConnection keyless(wrong), random(listener_->ticket());
    keyless.say_hello();
    random.say(Bytes(64, 0x55));
    turn_until([&] { return keyless.is_cut_off() && random.is_cut_off(); });
    EXPECT_EQ(warnings_.size(), 2u);

    RawConnection replayer(listener_->ticket());
    replayer.say_hello();
    turn_until([&] { return listener_->unproven() > 0; });
    listener_->poll();
    replayer.take_answer();
    ASSERT_TRUE(replayer.is_welcome());
    EXPECT_EQ(listener_->peers().size(), 1u) << "it has proved nothing yet";
    const Bytes said = replayer.frame(Bytes(10, 1));
    replayer.say(said);
    turn_until([&] { return listener_->peers().size() == 2; });
    replayer.say(said);
    turn_until([&] { return replayer.is_cut_off(); });
    EXPECT_EQ(listener_->peers(), std::vector<int>{kFirst});
    EXPECT_EQ(got_.back().bytes, Bytes(10, 1));
    ASSERT_EQ(warnings_.size(), 3u);
    EXPECT_NE(warnings_[2].find("repeated"), std::string::npos) << warnings_[2];

    const std::size_t before = got_.size();
    honest->send(0, payload(77));
    turn_until([&] { return got_.size() > before; });
    EXPECT_EQ(got_.back().bytes, *payload(77));
}

TEST_F(TcpChannelTest, WhoSaysTooLittleForTooLongIsCutOff) {
    open();
    RawConnection silent(listener_->ticket()), slow(listener_->ticket());
    slow.say(Bytes{'T', 'F'});
    turn_until([&] { return listener_->unproven() == 2; });
    now_ = 4.9;
    listener_->poll();
    EXPECT_EQ(listener_->unproven(), 2u);
    now_ = 5.1;
    slow.say(Bytes{'J'});
    turn_until([&] { return silent.is_cut_off() && slow.is_cut_off(); });
    EXPECT_EQ(listener_->unproven(), 0u);
    EXPECT_EQ(warnings_.size(), 2u);
}

TEST_F(TcpChannelTest, The65thThatProvesNothingClosesTheOldest) {
    open();
    std::vector<std::unique_ptr<RawConnection>> crowd;
    for (int k = 0; k < 64; ++k)
        crowd.push_back(std::make_unique<RawConnection>(listener_->ticket()));
    turn_until([&] { return listener_->unproven() == 64; });
    RawConnection last(listener_->ticket());
    turn_until([&] { return !warnings_.empty(); });
    crowd.front()->take_answer();
    EXPECT_EQ(crowd.front()->refusal(), JoinRefusal::crowded);
    EXPECT_TRUE(crowd.front()->is_cut_off());
    EXPECT_FALSE(last.is_cut_off());
    EXPECT_EQ(listener_->unproven(), 64u);
}

/// Strangers who connect anew as fast as they are closed keep nobody out.
TEST_F(TcpChannelTest, AGuestGetsInThroughACrowdThatNeverEnds) {
    open();
    std::vector<std::unique_ptr<RawConnection>> crowd;
    const auto push = [&](int count) {
        for (int k = 0; k < count; ++k)
            crowd.push_back(std::make_unique<RawConnection>(listener_->ticket()));
    };
    push(100);
    RawConnection honest(listener_->ticket());
    honest.say_hello();
    push(100);
    turn_until([&] { return honest.has_answer(); });
    honest.take_answer();
    ASSERT_TRUE(honest.is_welcome());
    push(100);
    for (int k = 0; k < 10; ++k)
        listener_->poll();
    EXPECT_EQ(listener_->unproven(), 64u);
    honest.say(honest.frame(Bytes(10, 1)));
    turn_until([&] { return listener_->peers().size() == 1; });
}

TEST_F(TcpChannelTest, AGuestThatTakesNothingInIsGivenUp) {
    open({.most_unsent = 1 << 20});
    const auto channel = guest();
    const Payload large = payload(std::size_t{32} << 20);
    listener_->send(kFirst, large);
    while (listener_->unsent(kFirst) > (20 << 20)) {  // it takes some
        listener_->drained();
        channel->poll();
    }
    now_ = 10.5;
    listener_->drained();
    EXPECT_TRUE(listener_->is_open(kFirst)) << "it is behind, but gets on";
    for (int k = 0; k < 100; ++k)
        listener_->drained();  // buffers are full now
    now_ = 21;
    listener_->drained();
    now_ = 32;
    listener_->drained();
    EXPECT_FALSE(listener_->is_open(kFirst));
    ASSERT_EQ(warnings_.size(), 1u);
    EXPECT_NE(warnings_[0].find("receives more slowly"), std::string::npos);
}

TEST_F(TcpChannelTest, UnknownConnectionsFillNoLog) {
    open();
    for (int k = 0; k < 30; ++k) {
        RawConnection raw(listener_->ticket());
        raw.say(Bytes(8, 1));
        turn_until([&] { return raw.is_cut_off(); });
    }
    EXPECT_EQ(warnings_.size(), 20u);
}

TEST_F(TcpChannelTest, AnAddressOrPortThatWillNotDoIsSaid) {
    GuestOptions options;
    options.address = "192.0.2.1";  // of documentation: nobody has it
    EXPECT_THROW(TcpChannel(options, 1), InputError);
    options.address = "no such host.";
    EXPECT_THROW(TcpChannel(options, 1), InputError);
    open();
    options.address = "127.0.0.1";
    options.port = listener_->ticket().port;
    try {
        TcpChannel(options, 1);
        ADD_FAILURE();
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("farm.join_port"), std::string::npos) << error.what();
    }
}

TEST_F(TcpChannelTest, AGuestIsToldWhatToDo) {
    open();
    const auto why = [&](const JoinTicket& ticket) {
        std::string text;
        std::atomic<bool> done = false;
        std::thread joining([&] {
            try {
                join_run(ticket, kBuild);
            } catch (const InputError& error) {
                text = error.what();
            }
            done = true;
        });
        while (!done) {
            listener_->poll();
            listener_->rest(1e-3);
        }
        joining.join();
        return text;
    };
    JoinTicket ticket = listener_->ticket();
    ticket.run[0] ^= 1;
    EXPECT_NE(why(ticket).find("another run uses this address"), std::string::npos);
    ticket = listener_->ticket();
    ticket.secret[0] ^= 1;
    EXPECT_NE(why(ticket).find("the secret of this ticket is not the run's"), std::string::npos);
    listener_->close(0);
    EXPECT_NE(why(listener_->ticket()).find("nobody answers"), std::string::npos);
}

TEST(TcpLink, LastWordsAreHeardThoughNothingCanBeSaidAnyMore) {
    int ends[2];
    ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends), 0);
    const JoinKey there{1}, back{2};
    TcpLink link(Socket(ends[0]), there, {back, kMostFrameBytes});
    {
        TcpLink other(Socket(ends[1]), back, {there, kMostFrameBytes});
        other.send(payload(100));
        EXPECT_TRUE(other.write());
    }
    link.send(payload(1));
    EXPECT_FALSE(link.write());
    EXPECT_TRUE(link.is_open());
    EXPECT_EQ(link.unsent(), 0u);
    std::vector<std::uint8_t> scratch(64);
    link.read(scratch);
    EXPECT_EQ(link.take(), *payload(100));
    EXPECT_FALSE(link.is_open());
}

TEST(MultiChannel, NumbersPeersOfBothInOneWay) {
    auto base = make_in_process_channels(3);
    MultiChannel channel(*base[0]);
    EXPECT_EQ(channel.peers(), (std::vector<int>{1, 2}));
    EXPECT_FALSE(channel.takes_guests());
    GuestOptions options;
    options.fingerprint = kBuild;
    const JoinTicket ticket = channel.take_guests(options);
    EXPECT_EQ(channel.take_guests(options), ticket) << "there is one door";
    std::atomic<bool> done = false;
    std::thread joining([&] {
        const auto guest = join_run(ticket, kBuild);
        guest->send(0, payload(3));
        while (guest->is_open(0)) {
            guest->poll();
            guest->rest(1e-3);
        }
        done = true;
    });
    base[1]->send(0, payload(1));
    std::vector<int> heard;
    while (heard.size() < 2) {
        if (const auto message = channel.poll()) heard.push_back(message->peer);
        channel.rest(1e-3);
    }
    std::sort(heard.begin(), heard.end());
    EXPECT_EQ(heard, (std::vector<int>{1, 3}));
    EXPECT_EQ(channel.peers(), (std::vector<int>{1, 2, 3}));
    EXPECT_EQ(channel.peer_count(), 4);
    EXPECT_TRUE(channel.is_guest(3));
    EXPECT_FALSE(channel.is_guest(2));
    channel.send(2, payload(5));
    EXPECT_EQ(base[2]->poll()->bytes, *payload(5));
    EXPECT_EQ(channel.bytes_received(), 4u);
    channel.close();
    joining.join();
    EXPECT_TRUE(done);
}

}  // namespace
}  // namespace treefarm
