// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <thread>

#include "common/comm/in_process_channel.h"

namespace treefarm {
namespace {

Payload text(const std::string& value) {
    return std::make_shared<const Bytes>(value.begin(), value.end());
}

std::string text(const Bytes& bytes) {
    return {bytes.begin(), bytes.end()};
}

TEST(InProcessChannel, DeliversInOrderWithTheSender) {
    auto channels = make_in_process_channels(3);
    EXPECT_EQ(channels[2]->self(), 2);
    EXPECT_EQ(channels[2]->peer_count(), 3);
    channels[1]->send(0, text("one"));
    channels[1]->send(0, text("two"));
    channels[2]->send(0, text("three"));
    const auto first = channels[0]->poll();
    ASSERT_TRUE(first);
    EXPECT_EQ(first->peer, 1);
    EXPECT_EQ(text(first->bytes), "one");
    EXPECT_EQ(text(channels[0]->poll()->bytes), "two");
    const auto third = channels[0]->poll();
    EXPECT_EQ(third->peer, 2);
    EXPECT_FALSE(channels[0]->poll());
    EXPECT_EQ(channels[1]->bytes_sent(), 6u);
    EXPECT_EQ(channels[0]->bytes_received(), 11u);
    EXPECT_TRUE(channels[1]->drained());
}

TEST(InProcessChannel, APayloadCanGoToManyPeers) {
    auto channels = make_in_process_channels(3);
    const Payload payload = text("tree");
    channels[0]->send(1, payload);
    channels[0]->send(2, payload);
    EXPECT_EQ(text(channels[1]->poll()->bytes), "tree");
    EXPECT_EQ(text(channels[2]->poll()->bytes), "tree");
}

TEST(InProcessChannel, ADeadPeerStopsNobody) {
    auto channels = make_in_process_channels(2);
    channels[1].reset();
    for (int i = 0; i < 1000; ++i)
        channels[0]->send(1, text("nobody hears this"));
    EXPECT_FALSE(channels[0]->poll());
}

TEST(InProcessChannel, ManyThreadsSendToOne) {
    constexpr int kWorkers = 4, kMessages = 500;
    auto channels = make_in_process_channels(kWorkers + 1);
    std::vector<std::thread> threads;
    for (int w = 1; w <= kWorkers; ++w)
        threads.emplace_back([&channel = *channels[static_cast<std::size_t>(w)]] {
            for (int i = 0; i < kMessages; ++i)
                channel.send(0, text(std::to_string(i)));
        });
    std::vector<int> next(kWorkers + 1, 0);
    for (int count = 0; count < kWorkers * kMessages;) {
        const auto message = channels[0]->poll();
        if (!message) {
            channels[0]->rest(0.01);
            continue;
        }
        EXPECT_EQ(text(message->bytes), std::to_string(next[static_cast<std::size_t>(message->peer)]++));
        ++count;
    }
    for (std::thread& thread : threads)
        thread.join();
}

}  // namespace
}  // namespace treefarm
