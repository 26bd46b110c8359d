// SPDX-License-Identifier: Apache-2.0
#include "common/comm/sealed_channel.h"

#include <gtest/gtest.h>

#include <fstream>

#include "common/base/error.h"
#include "common/comm/in_process_channel.h"
#include "common/comm/run_key.h"
#include "tests/support/test_folder.h"

namespace treefarm {
namespace {

Payload message(std::size_t size, std::uint8_t value) {
    return std::make_shared<const Bytes>(size, value);
}

class Sealed : public ::testing::Test {
  protected:
    static constexpr int kPeers = 3;
    const JoinKey secret_ = draw_join_key();
    const std::vector<JoinKey> nonces_ = {draw_join_key(), draw_join_key(), draw_join_key()};
    std::vector<std::unique_ptr<Channel>> plain_ = make_in_process_channels(kPeers);

    std::unique_ptr<SealedChannel> sealed(int peer) { return sealed(peer, secret_, nonces_); }
    std::unique_ptr<SealedChannel> sealed(int peer, const JoinKey& secret, const std::vector<JoinKey>& nonces) {
        return std::make_unique<SealedChannel>(*plain_[static_cast<std::size_t>(peer)], secret, nonces);
    }

    /// What a peer has sent to another, taken off the way.
    std::vector<Payload> catch_all(int to) {
        std::vector<Payload> caught;
        while (auto part = plain_[static_cast<std::size_t>(to)]->poll())
            caught.push_back(std::make_shared<const Bytes>(std::move(part->bytes)));
        return caught;
    }
    void resend(int from, int to, const std::vector<Payload>& parts) {
        for (const Payload& part : parts)
            plain_[static_cast<std::size_t>(from)]->send(to, part);
    }

    /// One message in which there is nothing, and then nothing.
    void expect_given_up(SealedChannel& channel, int peer) {
        const auto last = channel.poll();
        ASSERT_TRUE(last);
        EXPECT_EQ(last->peer, peer);
        EXPECT_TRUE(last->bytes.empty());
        EXPECT_FALSE(channel.poll());
    }
};

TEST_F(Sealed, MessagesArriveBetweenAllPairs) {
    std::vector<std::unique_ptr<SealedChannel>> all;
    for (int peer = 0; peer < kPeers; ++peer)
        all.push_back(sealed(peer));
    const std::vector<std::size_t> sizes = {1, 20, 0, 100'000, 20};
    for (int from = 0; from < kPeers; ++from)
        for (int to = 0; to < kPeers; ++to)
            for (const std::size_t size : sizes)
                if (from != to)
                    all[static_cast<std::size_t>(from)]->send(to, message(size, static_cast<std::uint8_t>(from + 1)));
    for (int to = 0; to < kPeers; ++to) {
        std::vector<std::size_t> got(kPeers, 0);
        while (const auto received = all[static_cast<std::size_t>(to)]->poll()) {
            const auto from = static_cast<std::size_t>(received->peer);
            ASSERT_LT(got[from], sizes.size());
            EXPECT_EQ(received->bytes, *message(sizes[got[from]++], static_cast<std::uint8_t>(from + 1)));
        }
        for (int from = 0; from < kPeers; ++from)
            EXPECT_EQ(got[static_cast<std::size_t>(from)], from == to ? 0 : sizes.size());
    }
}

TEST_F(Sealed, EachChangedBitEndsThePeer) {
    const auto worker = sealed(1);
    worker->send(0, message(40, 7));
    const std::vector<Payload> parts = catch_all(0);
    for (std::size_t part = 0; part < parts.size(); ++part)
        for (std::size_t bit = 0; bit < 8 * parts[part]->size(); bit += 5) {
            const auto coordinator = sealed(0);
            std::vector<Payload> changed = parts;
            Bytes bytes = *changed[part];
            bytes[bit / 8] ^= static_cast<std::uint8_t>(1u << bit % 8);
            changed[part] = std::make_shared<const Bytes>(bytes);
            resend(1, 0, changed);
            expect_given_up(*coordinator, 1);
        }
}

TEST_F(Sealed, WhatIsRepeatedLeftOutSwappedOrMadeUpEndsThePeer) {
    const auto worker = sealed(1);
    worker->send(0, message(1, 1));
    worker->send(0, message(2, 2));
    const std::vector<Payload> p = catch_all(0);
    ASSERT_EQ(p.size(), 4u);
    struct Case {
        std::vector<Payload> parts;
        int good;  ///< messages before
    };
    const std::vector<Case> cases = {
        {{p[0], p[1], p[0], p[1]}, 1}, {{p[2], p[3]}, 0}, {{p[0], p[3]}, 0}, {{p[1]}, 0}, {{message(20, 0), p[1]}, 0}};
    for (const Case& each : cases) {
        const auto coordinator = sealed(0);
        resend(1, 0, each.parts);
        for (int k = 0; k < each.good; ++k)
            EXPECT_FALSE(coordinator->poll()->bytes.empty());
        expect_given_up(*coordinator, 1);
    }
}

TEST_F(Sealed, AMessageForAnotherOrOfAnotherSessionIsNone) {
    const auto worker = sealed(1);
    worker->send(0, message(9, 9));
    const std::vector<Payload> parts = catch_all(0);
    resend(1, 2, parts);
    expect_given_up(*sealed(2), 1);
    resend(2, 0, parts);
    expect_given_up(*sealed(0), 2);
    auto later = nonces_;
    later[0] = draw_join_key();
    resend(1, 0, parts);
    expect_given_up(*sealed(0, secret_, later), 1);
    resend(1, 0, parts);
    expect_given_up(*sealed(0, draw_join_key(), nonces_), 1);
}

TEST_F(Sealed, OthersAreHeardWhenOneIsNot) {
    const auto coordinator = sealed(0), liar = sealed(1), worker = sealed(2);
    resend(1, 0, {message(3, 3)});
    expect_given_up(*coordinator, 1);
    liar->send(0, message(4, 4));
    worker->send(0, message(5, 5));
    const auto received = coordinator->poll();
    ASSERT_TRUE(received);
    EXPECT_EQ(received->peer, 2);
    EXPECT_EQ(received->bytes, *message(5, 5));
    EXPECT_FALSE(coordinator->poll());
}

TEST(RunKey, IsReadWhereNobodyElseCouldHave) {
    const auto path = test::fresh_test_folder() / "key";
    EXPECT_THROW(read_run_key(path), InputError);
    write_run_key(path);
    const JoinKey key = read_run_key(path);
    EXPECT_EQ(key, read_run_key(path));
    write_run_key(path);
    EXPECT_NE(key, read_run_key(path)) << "each attempt has its own";
    using std::filesystem::perms;
    EXPECT_EQ(std::filesystem::status(path).permissions(), perms::owner_read | perms::owner_write);
    std::filesystem::permissions(path, perms::owner_read | perms::group_read);
    EXPECT_THROW(read_run_key(path), InputError);
    std::filesystem::permissions(path, perms::owner_read);
    std::ofstream(path, std::ios::app) << "x";
    EXPECT_THROW(read_run_key(path), InputError) << "too long";
}

}  // namespace
}  // namespace treefarm
