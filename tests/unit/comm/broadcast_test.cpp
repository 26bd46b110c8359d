// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "common/comm/broadcast_chain.h"
#include "common/comm/in_process_channel.h"

namespace treefarm {
namespace {

Bytes pattern(std::size_t size) {
    Bytes bytes(size);
    for (std::size_t i = 0; i < size; ++i)
        bytes[i] = static_cast<std::uint8_t>(i * 31 + i / 256);
    return bytes;
}

/// A coordinator and some workers that are stepped by hand.
struct Farm {
    explicit Farm(int workers) : channels(make_in_process_channels(workers + 1)) {
        for (int w = 1; w <= workers; ++w) {
            receivers.push_back(std::make_unique<ChainReceiver>(*channels[static_cast<std::size_t>(w)]));
            chain.push_back(static_cast<std::uint32_t>(w));
        }
    }

    /// Lets every worker take what has arrived until nothing moves; `drop(worker, chunk)` loses pieces on the way in.
    template <class Drop>
    void settle(Drop drop) {
        for (bool moved = true; moved;) {
            moved = false;
            for (std::size_t w = 1; w < channels.size(); ++w)
                while (const auto message = channels[w]->poll()) {
                    moved = true;
                    const auto chunk = std::get<Chunk>(decode(message->bytes));
                    if (!drop(static_cast<int>(w), chunk)) receivers[w - 1]->take(chunk, now);
                }
        }
    }
    void settle() {
        settle([](int, const Chunk&) { return false; });
    }

    std::vector<std::pair<int, Resend>> complaints() {
        std::vector<std::pair<int, Resend>> found;
        while (const auto message = channels[0]->poll())
            found.emplace_back(message->peer, std::get<Resend>(decode(message->bytes)));
        return found;
    }

    double now = 0;
    std::vector<std::unique_ptr<Channel>> channels;
    std::vector<std::unique_ptr<ChainReceiver>> receivers;
    std::vector<std::uint32_t> chain;
};

constexpr BlobName kTree{Blob::tree, 0, 3};

class BroadcastChain : public ::testing::TestWithParam<int> {};

TEST_P(BroadcastChain, EveryWorkerGetsTheSameBytesAndTheCoordinatorSendsThemOnce) {
    Farm farm(GetParam());
    const Bytes tree = pattern(10'050);
    send_along_chain(*farm.channels[0], kTree, tree, 0, farm.chain, 1000);
    EXPECT_LT(farm.channels[0]->bytes_sent(), 1.2 * static_cast<double>(tree.size()));
    farm.settle();
    for (const auto& receiver : farm.receivers) {
        EXPECT_EQ(receiver->collect(kTree), tree);
        EXPECT_FALSE(receiver->collect(kTree)) << "handed out twice";
    }
    EXPECT_TRUE(farm.complaints().empty());
}

TEST_P(BroadcastChain, AMissingPieceIsAskedForAndThenAllIsWhole) {
    Farm farm(GetParam());
    const Bytes tree = pattern(5'000);
    const int deaf = (GetParam() + 1) / 2;
    send_along_chain(*farm.channels[0], kTree, tree, 0, farm.chain, 1000);
    farm.settle([&](int worker, const Chunk& chunk) { return worker == deaf && chunk.offset == 2000; });
    const auto complaints = farm.complaints();
    ASSERT_FALSE(complaints.empty());
    for (const auto& [peer, resend] : complaints) {
        EXPECT_GE(peer, deaf);
        EXPECT_EQ(resend, (Resend{Blob::tree, 0, 3, 2000}));
        const std::uint32_t only[] = {static_cast<std::uint32_t>(peer)};
        send_along_chain(*farm.channels[0], kTree, tree, resend.offset, only, 1000);
    }
    EXPECT_EQ(complaints.size(), static_cast<std::size_t>(GetParam() - deaf + 1)) << "one each, from the deaf one on";
    farm.settle();
    for (const auto& receiver : farm.receivers)
        EXPECT_EQ(receiver->collect(kTree), tree);
}

INSTANTIATE_TEST_SUITE_P(Workers, BroadcastChain, ::testing::Values(1, 2, 5));

TEST(ChainReceiver, NoticesSilence) {
    Farm farm(1);
    ChainReceiver& receiver = *farm.receivers[0];
    receiver.expect(kTree, 100, 10.0);
    receiver.complain(11.0, 2.0);
    EXPECT_TRUE(farm.complaints().empty()) << "too early";
    receiver.complain(12.5, 2.0);
    EXPECT_EQ(farm.complaints().size(), 1u);
    receiver.complain(13.0, 2.0);
    EXPECT_TRUE(farm.complaints().empty()) << "asked again too soon";
    receiver.complain(15.0, 2.0);
    EXPECT_EQ(farm.complaints().size(), 1u);
}

TEST(ChainReceiver, TheLastPieceMissingIsNoticedBySilence) {
    Farm farm(1);
    const Bytes tree = pattern(3'000);
    send_along_chain(*farm.channels[0], kTree, tree, 0, farm.chain, 1000);
    farm.settle([&](int, const Chunk& chunk) { return chunk.offset == 2000; });
    EXPECT_FALSE(farm.receivers[0]->collect(kTree));
    farm.receivers[0]->complain(5.0, 2.0);
    const auto complaints = farm.complaints();
    ASSERT_EQ(complaints.size(), 1u);
    EXPECT_EQ(complaints[0].second.offset, 2000u);
}

TEST(ChainReceiver, LatePiecesOfACollectedBlobAreDropped) {
    Farm farm(1);
    const Bytes tree = pattern(3'000);
    send_along_chain(*farm.channels[0], kTree, tree, 0, farm.chain, 1000);
    send_along_chain(*farm.channels[0], kTree, tree, 0, farm.chain, 1000);
    farm.settle();
    EXPECT_EQ(farm.receivers[0]->collect(kTree), tree);
    send_along_chain(*farm.channels[0], kTree, tree, 0, farm.chain, 1000);
    farm.settle();
    EXPECT_FALSE(farm.receivers[0]->collect(kTree));
    farm.receivers[0]->complain(100.0, 1.0);
    EXPECT_TRUE(farm.complaints().empty());
}

// Any peer can send a piece: one that lies must cost neither the blob nor the worker.

TEST(ChainReceiver, APieceThatDoesNotFitTheAnnouncementIsDropped) {
    Farm farm(2);
    ChainReceiver& receiver = *farm.receivers[0];
    receiver.take({Blob::tree, 0, 3, 99, 0, {}, Bytes(10)}, 0, 2);  // before the coordinator has said a word
    receiver.expect(kTree, 2000, 0);
    receiver.take({Blob::tree, 0, 3, 99, 10, {}, Bytes(10)}, 0, 2);
    const Bytes tree = pattern(2000);
    send_along_chain(*farm.channels[0], kTree, tree, 0, farm.chain, 1000);
    farm.settle();
    EXPECT_EQ(receiver.collect(kTree), tree);
}

TEST(ChainReceiver, APieceGoesOnlyWhereTheCoordinatorCanHaveSentIt) {
    Farm farm(3);
    const std::vector<std::vector<std::uint32_t>> chains = {{7}, {0}, {1}, {2, 3, 2, 3, 2, 3}, {0xffffffff}};
    for (const auto& chain : chains)
        farm.receivers[0]->take({Blob::tree, 0, 3, 100, 0, chain, Bytes(10)}, 0, 2);
    for (const auto& channel : farm.channels)
        EXPECT_FALSE(channel->poll()) << "peer " << channel->self();
}

TEST(ChainReceiver, InventedBlobsTakeNoMemory) {
    Farm farm(2);
    ChainReceiver& receiver = *farm.receivers[0];
    int kept = 0;
    for (std::uint32_t epoch = 1; epoch < 100; ++epoch)
        kept += receiver.take({Blob::tree, 0, epoch, 1 << 20, 0, {}, Bytes(1 << 20)}, 0, 2).has_value();
    EXPECT_LT(kept, 17);
    const BlobName announced{Blob::tree, 0, 200};
    receiver.expect(announced, 2000, 0);
    const Bytes tree = pattern(2000);
    send_along_chain(*farm.channels[0], announced, tree, 0, farm.chain, 1000);
    farm.settle();
    EXPECT_EQ(receiver.collect(announced), tree) << "what was announced always has room";
}

TEST(ChainReceiver, AWrongBlobIsAskedForAgainAndTakenFromTheCoordinatorAlone) {
    Farm farm(2);
    ChainReceiver& receiver = *farm.receivers[0];
    const Bytes tree = pattern(1000);
    receiver.expect(kTree, 1000, 0);
    receiver.take({Blob::tree, 0, 3, 1000, 0, {}, Bytes(1000)}, 0, 2);
    EXPECT_NE(receiver.collect(kTree), tree);
    EXPECT_TRUE(receiver.mistrust(kTree, 1000, 1.0));
    ASSERT_EQ(farm.complaints().size(), 1u);
    receiver.take({Blob::tree, 0, 3, 1000, 0, {}, Bytes(1000)}, 2, 2);
    EXPECT_FALSE(receiver.collect(kTree)) << "the liar's again";
    receiver.take({Blob::tree, 0, 3, 1000, 0, {}, tree}, 3, 0);
    EXPECT_EQ(receiver.collect(kTree), tree);
    EXPECT_FALSE(receiver.mistrust(kTree, 1000, 4.0)) << "then it is the coordinator's own word that is wrong";
}

TEST(ChainReceiver, CopiesOfAPieceDoNotKeepABlobWaiting) {
    Farm farm(2);
    ChainReceiver& receiver = *farm.receivers[0];
    receiver.expect(kTree, 100, 0);
    receiver.take({Blob::tree, 0, 3, 100, 0, {}, Bytes(10)}, 0, 2);
    for (double now = 0.5; now < 3.0; now += 0.5)
        receiver.take({Blob::tree, 0, 3, 100, 0, {}, Bytes(10)}, now, 2);
    receiver.complain(3.0, 2.0);
    EXPECT_EQ(farm.complaints().size(), 1u);
}

TEST(ChainReceiver, AnEmptyBlobArrives) {
    Farm farm(2);
    send_along_chain(*farm.channels[0], kTree, {}, 0, farm.chain);
    farm.settle();
    EXPECT_EQ(farm.receivers[1]->collect(kTree), Bytes{});
}

}  // namespace
}  // namespace treefarm
