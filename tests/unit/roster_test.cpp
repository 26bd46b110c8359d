// SPDX-License-Identifier: Apache-2.0
#include "coordinator/farm/roster.h"

#include <gtest/gtest.h>

namespace treefarm {
namespace {

Hello hello(std::uint64_t incarnation, std::uint32_t threads = 2) {
    Hello message;
    message.incarnation = incarnation;
    message.threads = threads;
    return message;
}

TEST(Roster, KnowsWorkersByPeerAndIncarnation) {
    Roster roster(10.0);
    roster.admit(1, hello(100), 0.0);
    EXPECT_NE(roster.hear(1, 100, 1.0), nullptr);
    EXPECT_EQ(roster.hear(1, 101, 1.0), nullptr) << "an earlier or later life";
    EXPECT_EQ(roster.hear(2, 100, 1.0), nullptr) << "another peer";
    EXPECT_EQ(roster.thread_count(), 2u);
}

TEST(Roster, SilenceIsNoticedAndSpeakingResetsIt) {
    Roster roster(10.0);
    roster.admit(1, hello(100), 0.0);
    roster.admit(2, hello(200, 5), 0.0);
    EXPECT_TRUE(roster.overdue(10.0).empty());
    roster.hear(2, 200, 9.0);
    const auto silent = roster.overdue(11.0);
    ASSERT_EQ(silent.size(), 1u);
    EXPECT_EQ(silent[0]->peer, 1);
    silent[0]->state = MemberState::lost;
    EXPECT_TRUE(roster.overdue(11.0).empty()) << "reported once";
    EXPECT_EQ(roster.hear(1, 100, 12.0), nullptr) << "a lost worker's messages are dropped";
    EXPECT_EQ(roster.present_count(), 1u);
    EXPECT_EQ(roster.thread_count(), 5u);
}

TEST(Roster, WhatNobodyListenedToIsNoSilence) {
    Roster roster(10.0);
    roster.admit(1, hello(100), 0.0);
    roster.excuse(30.0);
    EXPECT_TRUE(roster.overdue(40.0).empty());
    EXPECT_EQ(roster.overdue(40.5).size(), 1u);
}

TEST(Roster, ANewLifeReplacesTheOld) {
    Roster roster(10.0);
    roster.admit(1, hello(100), 0.0).state = MemberState::lost;
    roster.admit(1, hello(101), 5.0).credit = 3;
    EXPECT_EQ(roster.hear(1, 100, 6.0), nullptr);
    ASSERT_NE(roster.hear(1, 101, 6.0), nullptr);
    EXPECT_EQ(roster.find(1)->credit, 3u);
    EXPECT_EQ(roster.present_count(), 1u);
}

}  // namespace
}  // namespace treefarm
