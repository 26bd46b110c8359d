// SPDX-License-Identifier: Apache-2.0
#include "common/comm/frames.h"

#include <sodium.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "common/comm/channel.h"

namespace treefarm {

namespace {

constexpr std::size_t kLengthBytes = 4;
constexpr std::uint32_t kMoreBit = std::uint32_t{1} << 31;

/// Bytes reserved before any have arrived.
constexpr std::size_t kFirstRoom = std::size_t{1} << 20;

static_assert(kFrameHeadBytes == kLengthBytes + crypto_onetimeauth_poly1305_BYTES);
static_assert(sizeof(JoinKey) == crypto_stream_chacha20_KEYBYTES);
static_assert(sizeof(std::uint64_t) == crypto_stream_chacha20_NONCEBYTES);

using Mac = std::array<std::uint8_t, crypto_onetimeauth_poly1305_BYTES>;

Mac frame_mac(const JoinKey& key, std::uint64_t sequence, std::uint32_t length, std::span<const std::uint8_t> bytes) {
    std::uint8_t nonce[sizeof sequence], once[crypto_onetimeauth_poly1305_KEYBYTES];
    std::memcpy(nonce, &sequence, sizeof sequence);
    crypto_stream_chacha20(once, sizeof once, nonce, key.data());
    crypto_onetimeauth_poly1305_state state;
    crypto_onetimeauth_poly1305_init(&state, once);
    std::uint8_t head[kLengthBytes];
    std::memcpy(head, &length, sizeof head);
    crypto_onetimeauth_poly1305_update(&state, head, sizeof head);
    crypto_onetimeauth_poly1305_update(&state, bytes.data(), bytes.size());
    Mac mac;
    crypto_onetimeauth_poly1305_final(&state, mac.data());
    return mac;
}

}  // namespace

FrameHead frame_head(const JoinKey& key, std::uint64_t sequence, std::span<const std::uint8_t> bytes, bool more) {
    const std::uint32_t length = static_cast<std::uint32_t>(bytes.size()) | (more ? kMoreBit : 0);
    const Mac mac = frame_mac(key, sequence, length, bytes);
    FrameHead head;
    std::memcpy(head.data(), &length, kLengthBytes);
    std::copy(mac.begin(), mac.end(), head.begin() + kLengthBytes);
    return head;
}

bool is_head_of(const FrameHead& head, const JoinKey& key, std::uint64_t sequence,
                std::span<const std::uint8_t> bytes) {
    const FrameHead right = frame_head(key, sequence, bytes, false);
    return sodium_memcmp(head.data(), right.data(), right.size()) == 0;
}

void FrameReader::feed(std::span<const std::uint8_t> bytes) {
    for (;;) {
        if (head_bytes_ < head_.size()) {
            const std::size_t count = std::min(head_.size() - head_bytes_, bytes.size());
            std::copy_n(bytes.begin(), count, head_.begin() + static_cast<std::ptrdiff_t>(head_bytes_));
            head_bytes_ += count;
            bytes = bytes.subspan(count);
            if (head_bytes_ < head_.size()) return;
            begin_frame();
        }
        const std::size_t count = std::min(length_ - body_.size(), bytes.size());
        body_.insert(body_.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count));
        bytes = bytes.subspan(count);
        if (body_.size() < length_) return;
        end_frame();
    }
}

void FrameReader::begin_frame() {
    std::uint32_t length;
    std::memcpy(&length, head_.data(), sizeof length);
    more_ = (length & kMoreBit) != 0;
    length_ = length & ~kMoreBit;
    if (length_ > most_bytes_)
        throw FormatError("a frame of " + std::to_string(length_) + " bytes, where " + std::to_string(most_bytes_) +
                          " are allowed");
    if (assembled_.size() + length_ > kLongestMessage) throw FormatError("a message that is too long");
    if (more_ && length_ == 0) throw FormatError("a part of nothing");
    body_.reserve(std::min(length_, kFirstRoom));
}

void FrameReader::end_frame() {
    const Mac mac = frame_mac(key_, sequence_, static_cast<std::uint32_t>(length_) | (more_ ? kMoreBit : 0), body_);
    if (crypto_verify_16(mac.data(), head_.data() + kLengthBytes) != 0)
        throw FormatError("a frame whose MAC is wrong: of another key, changed, repeated or out of turn");
    ++sequence_;
    head_bytes_ = 0;
    if (assembled_.empty())
        assembled_ = std::exchange(body_, {});
    else
        assembled_.insert(assembled_.end(), body_.begin(), body_.end());
    body_.clear();
    if (!more_) messages_.push_back(std::exchange(assembled_, {}));
}

std::optional<Bytes> FrameReader::next() {
    if (messages_.empty()) return std::nullopt;
    Bytes message = std::move(messages_.front());
    messages_.pop_front();
    return message;
}

}  // namespace treefarm
