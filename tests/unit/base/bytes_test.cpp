// SPDX-License-Identifier: Apache-2.0
#include "common/base/bytes.h"

#include <gtest/gtest.h>

namespace treefarm {
namespace {

/// Where many bytes follow a number is read as one word, at the end byte by byte: both must agree.
std::vector<std::size_t> what_follows() {
    return {0, 1, 7, 8, 20};
}

Bytes followed(Bytes bytes, std::size_t by) {
    bytes.insert(bytes.end(), by, 0xff);
    return bytes;
}

TEST(Bytes, VarintsOfEveryLengthComeBack) {
    for (int bits = 0; bits <= 64; ++bits)
        for (const std::uint64_t low : {0u, 1u}) {
            const std::uint64_t value = (bits == 64 ? 0 : std::uint64_t{1} << bits) - low;
            ByteWriter writer;
            writer.put_varint(value);
            const Bytes written = writer.take();
            for (const std::size_t more : what_follows()) {
                const Bytes bytes = followed(written, more);
                ByteReader reader(bytes);
                EXPECT_EQ(reader.get_varint(), value);
                EXPECT_EQ(reader.remaining(), more);
            }
        }
}

TEST(Bytes, VarintsHaveOneForm) {
    for (std::size_t length = 2; length <= 10; ++length) {
        Bytes padded(length, 0x80);
        padded.back() = 0;
        for (const std::size_t more : what_follows())
            EXPECT_THROW(ByteReader(followed(padded, more)).get_varint(), FormatError) << length << ", " << more;
    }
}

TEST(Bytes, VarintsThatDoNotEndAreRefused) {
    for (std::size_t length = 0; length <= 12; ++length)
        EXPECT_THROW(ByteReader(Bytes(length, 0xff)).get_varint(), FormatError) << length;
    Bytes too_many_bits(10, 0xff);
    too_many_bits.back() = 2;
    EXPECT_THROW(ByteReader(too_many_bits).get_varint(), FormatError);
}

}  // namespace
}  // namespace treefarm
