// SPDX-License-Identifier: Apache-2.0
#include "common/comm/handshake.h"

#include <gtest/gtest.h>

#include <functional>

#include "common/protocol/envelope.h"
#include "tests/support/join_keys.h"

// Frames and handshake as bytes: however they are cut, and whatever is done to them on the way.

namespace treefarm {
namespace {

using test::key_of;

constexpr std::uint64_t kHandshakeBuild = 7;

JoinTicket ticket() {
    JoinTicket ticket{{}, "localhost", 1, key_of(3)};
    ticket.run.fill(9);
    return ticket;
}

Bytes bytes_of(std::size_t count, int salt = 0) {
    Bytes bytes(count);
    for (std::size_t k = 0; k < count; ++k)
        bytes[k] = static_cast<std::uint8_t>(k * 31 + static_cast<std::size_t>(salt));
    return bytes;
}

Bytes operator+(Bytes a, const Bytes& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

Bytes frame(std::uint64_t sequence, const Bytes& bytes, bool more = false, std::uint8_t key = 1) {
    const FrameHead head = frame_head(key_of(key), sequence, bytes, more);
    return Bytes(head.begin(), head.end()) + bytes;
}

FrameReader reader(std::size_t most = kMostFrameBytes) {
    return {key_of(1), most};
}

std::vector<Bytes> messages(FrameReader& from) {
    std::vector<Bytes> all;
    while (auto message = from.next())
        all.push_back(std::move(*message));
    return all;
}

TEST(Frames, BecomeMessagesHoweverTheyAreCut) {
    const Bytes stream = frame(0, bytes_of(5)) + frame(1, {}) + frame(2, bytes_of(40), true) +
                         frame(3, bytes_of(30, 1), true) + frame(4, {}) + frame(5, bytes_of(1));
    const std::vector<Bytes> should = {bytes_of(5), {}, bytes_of(40) + bytes_of(30, 1), bytes_of(1)};
    for (std::size_t cut = 0; cut <= stream.size(); ++cut) {
        FrameReader whole = reader();
        whole.feed(std::span(stream).first(cut));
        whole.feed(std::span(stream).subspan(cut));
        EXPECT_EQ(messages(whole), should) << cut;
    }
    FrameReader single = reader();
    for (const std::uint8_t byte : stream)
        single.feed({&byte, 1});
    EXPECT_EQ(messages(single), should);
}

TEST(Frames, OneThatIsCutShortIsNoMessage) {
    const Bytes stream = frame(0, bytes_of(40));
    FrameReader cut = reader();
    cut.feed(std::span(stream).first(stream.size() - 1));
    EXPECT_FALSE(cut.has_message());
}

TEST(Frames, EveryBitIsUnderTheMac) {
    const Bytes stream = frame(0, bytes_of(9)) + frame(1, bytes_of(3));
    for (std::size_t bit = 0; bit < 8 * stream.size(); ++bit) {
        Bytes changed = stream;
        changed[bit / 8] = static_cast<std::uint8_t>(changed[bit / 8] ^ (1 << (bit % 8)));
        FrameReader careful = reader(100);
        bool refused = false;
        try {
            careful.feed(changed);
        } catch (const FormatError&) {
            refused = true;
        }
        // A length that has grown waits for what never comes.
        const std::vector<Bytes> got = messages(careful);
        EXPECT_TRUE(refused || got.size() < 2) << bit;
        if (!got.empty()) {
            EXPECT_EQ(got[0], bytes_of(9)) << bit;
        }
        EXPECT_LT(got.size(), 2u) << bit;
    }
}

TEST(Frames, WhatIsRepeatedLeftOutSwappedOrForeignIsRefused) {
    const Bytes zero = frame(0, bytes_of(4)), one = frame(1, bytes_of(4)), two = frame(2, bytes_of(4));
    for (const Bytes& stream : {zero + zero, zero + two, one + zero, frame(0, bytes_of(4), false, 2)}) {
        FrameReader careful = reader();
        EXPECT_THROW(careful.feed(stream), FormatError);
        EXPECT_LE(messages(careful).size(), 1u);
    }
}

TEST(Frames, OneThatIsTooLongIsRefusedByItsHead) {
    const Bytes stream = frame(0, bytes_of(101));
    FrameReader careful = reader(100);
    EXPECT_THROW(careful.feed(std::span(stream).first(kFrameHeadBytes)), FormatError);
}

TEST(Frames, PartsOfNothingAreRefused) {
    FrameReader careful = reader();
    EXPECT_THROW(careful.feed(frame(0, {}, true)), FormatError);
}

/// Both ends, joined by whatever `change` makes of the bytes between them.
struct Meeting {
    std::function<Bytes(Bytes)> on_hello = [](Bytes b) { return b; }, on_answer = on_hello;
    JoinTicket of_guest = ticket(), of_listener = ticket();
    std::uint64_t build_of_guest = kHandshakeBuild;

    std::string run() {
        ListenerHandshake listener(of_listener, kHandshakeBuild, key_of(5));
        GuestHandshake guest(of_guest, build_of_guest, key_of(6));
        std::string why;
        try {
            listener.take(on_hello(guest.hello()));
        } catch (const FormatError& error) {
            why = error.what();
        }
        guest.take(on_answer(listener.take_answer()));
        refusal = guest.refusal();
        if (!why.empty() || !guest.is_welcome()) return why;
        EXPECT_FALSE(listener.is_admitted()) << "it has proved nothing yet";
        const Bytes first = bytes_of(33);
        const FrameHead head = frame_head(guest.sending_key(), 0, first, false);
        listener.take(Bytes(head.begin(), head.end()) + first);
        EXPECT_TRUE(listener.is_admitted());
        EXPECT_EQ(listener.take_reader().next(), first);
        EXPECT_NE(guest.sending_key(), listener.sending_key());
        FrameReader back = guest.take_reader();
        const FrameHead reply = frame_head(listener.sending_key(), 0, first, false);
        back.feed(Bytes(reply.begin(), reply.end()) + first);
        EXPECT_EQ(back.next(), first);
        return "";
    }
    JoinRefusal refusal = JoinRefusal::none;
};

TEST(Handshake, TwoWithOneSecretUnderstandEachOther) {
    EXPECT_EQ(Meeting().run(), "");
}

TEST(Handshake, AGuestIsToldWhyItIsTurnedAway) {
    Meeting run, secret, build, protocol, version;
    run.of_guest.run[3] ^= 1;
    secret.of_guest.secret[31] ^= 1;
    build.build_of_guest = 8;
    protocol.on_hello = [](Bytes hello) {
        hello[8] = static_cast<std::uint8_t>(kProtocolVersion + 1);
        return hello;
    };
    version.on_hello = [](Bytes hello) {
        ++hello[4];
        return hello;
    };
    for (auto& [meeting, refusal] : {std::pair(&run, JoinRefusal::run), std::pair(&secret, JoinRefusal::secret),
                                     std::pair(&build, JoinRefusal::build), std::pair(&protocol, JoinRefusal::protocol),
                                     std::pair(&version, JoinRefusal::version)}) {
        EXPECT_EQ(meeting->run(), refusal_text(refusal).what);
        EXPECT_EQ(meeting->refusal, refusal);
        EXPECT_FALSE(refusal_text(refusal).cure.empty());
    }
}

TEST(Handshake, EveryBitOfTheHelloIsUnderItsProof) {
    for (std::size_t bit = 0; bit < 8 * GuestHandshake(ticket(), kHandshakeBuild, key_of(6)).hello().size(); ++bit) {
        Meeting meeting;
        meeting.on_hello = [&](Bytes hello) {
            hello[bit / 8] = static_cast<std::uint8_t>(hello[bit / 8] ^ (1 << (bit % 8)));
            return hello;
        };
        EXPECT_NE(meeting.run(), "") << bit;
    }
}

TEST(Handshake, EveryBitOfTheAnswerIsUnderItsProof) {
    for (std::size_t bit = 0; bit < 8 * 69; ++bit) {
        Meeting meeting;
        meeting.on_answer = [&](Bytes answer) {
            EXPECT_EQ(answer.size(), 69u);
            answer[bit / 8] = static_cast<std::uint8_t>(answer[bit / 8] ^ (1 << (bit % 8)));
            return answer;
        };
        try {
            meeting.run();
            EXPECT_NE(meeting.refusal, JoinRefusal::none) << bit;  // anybody can turn a guest away
        } catch (const FormatError&) {
        }
    }
}

TEST(Handshake, WhoRepeatsAnothersWordsIsNoGuest) {
    GuestHandshake guest(ticket(), kHandshakeBuild, key_of(6));
    ListenerHandshake first(ticket(), kHandshakeBuild, key_of(5)), second(ticket(), kHandshakeBuild, key_of(4));
    first.take(guest.hello());
    guest.take(first.take_answer());
    const Bytes message = bytes_of(10);
    const FrameHead head = frame_head(guest.sending_key(), 0, message, false);
    second.take(guest.hello());
    EXPECT_THROW(second.take(Bytes(head.begin(), head.end()) + message), FormatError);
    EXPECT_FALSE(second.is_admitted());
}

TEST(Handshake, WhoSaysMuchAndProvesNothingIsCutOff) {
    ListenerHandshake listener(ticket(), kHandshakeBuild, key_of(5));
    GuestHandshake guest(ticket(), kHandshakeBuild, key_of(6));
    listener.take(guest.hello());
    Bytes frame(kFrameHeadBytes);
    frame[1] = kMostUnprovenBytes >> 8;  // its length
    listener.take(frame);
    const std::size_t left = kMostUnprovenBytes - guest.hello().size() - frame.size();
    listener.take(Bytes(left));
    EXPECT_THROW(listener.take(Bytes(1)), FormatError);
}

TEST(Handshake, AForeignProtocolIsKnownByItsFirstBytes) {
    for (const std::size_t wrong : {std::size_t{0}, std::size_t{3}, std::size_t{4}, std::size_t{7}}) {
        ListenerHandshake listener(ticket(), kHandshakeBuild, key_of(5));
        Bytes begin(GuestHandshake(ticket(), kHandshakeBuild, key_of(6)).hello());
        begin.resize(8);
        begin[wrong] ^= 1;
        EXPECT_THROW(listener.take(begin), FormatError) << wrong;
    }
}

TEST(Handshake, MayComeByteByByte) {
    ListenerHandshake listener(ticket(), kHandshakeBuild, key_of(5));
    GuestHandshake guest(ticket(), kHandshakeBuild, key_of(6));
    for (const std::uint8_t byte : guest.hello())
        listener.take({&byte, 1});
    for (const std::uint8_t byte : listener.take_answer())
        guest.take({&byte, 1});
    EXPECT_TRUE(guest.is_welcome());
}

}  // namespace
}  // namespace treefarm
