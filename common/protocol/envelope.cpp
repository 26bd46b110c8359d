// SPDX-License-Identifier: Apache-2.0
#include "common/protocol/envelope.h"

#include "common/base/hash.h"

namespace treefarm {

namespace {

constexpr std::uint32_t kMagic = 0x4d524654;  // "TFRM"
constexpr std::size_t kChecksumAt = 8;
constexpr std::size_t kCoveredFrom = 16;

template <class T>
void patch(Bytes& bytes, std::size_t at, T value) {
    std::memcpy(bytes.data() + at, &value, sizeof value);
}

}  // namespace

EnvelopeWriter::EnvelopeWriter(Kind kind) {
    writer_.put(kMagic);
    writer_.put(kProtocolVersion);
    writer_.put<std::uint64_t>(0);  // checksum
    writer_.put<std::uint64_t>(0);  // length
    writer_.put(static_cast<std::uint8_t>(kind));
}

Bytes EnvelopeWriter::seal() {
    Bytes bytes = writer_.take();
    patch<std::uint64_t>(bytes, kCoveredFrom, bytes.size() - kEnvelopeBytes);
    patch(bytes, kChecksumAt, hash_bytes(std::span(bytes).subspan(kCoveredFrom)));
    return bytes;
}

Envelope open_envelope(std::span<const std::uint8_t> message) {
    ByteReader reader(message);
    if (reader.get<std::uint32_t>() != kMagic) throw FormatError("not a treefarm message: wrong magic number");
    const auto version = reader.get<std::uint32_t>();
    if (version != kProtocolVersion)
        throw FormatError("message of protocol version " + std::to_string(version) + ", this program speaks version " +
                          std::to_string(kProtocolVersion));
    const auto checksum = reader.get<std::uint64_t>();
    const auto length = reader.get<std::uint64_t>();
    const auto kind = reader.get<std::uint8_t>();
    if (length != reader.remaining())
        throw FormatError("message of " + std::to_string(length) + " bytes, " + std::to_string(reader.remaining()) +
                          " arrived");
    if (checksum != hash_bytes(message.subspan(kCoveredFrom))) throw FormatError("message with a wrong checksum");
    if (kind == 0 || kind > static_cast<std::uint8_t>(kLastKind))
        throw FormatError("message of unknown kind " + std::to_string(kind));
    return {static_cast<Kind>(kind), reader.get_rest()};
}

}  // namespace treefarm
