// SPDX-License-Identifier: Apache-2.0
#include "coordinator/checkpoint/section_file.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "common/base/hash_stream.h"

namespace treefarm {
namespace {

constexpr std::uint32_t kOne = section_tag("ONE1"), kTwo = section_tag("TWO2");

SectionFile two_sections() {
    return {7, {{kOne, 1, {1, 2, 3}}, {kTwo, 3, Bytes(1000, 42)}}};
}

std::string fault_of(const Bytes& bytes) {
    try {
        decode_sections(bytes);
    } catch (const FormatError& error) {
        return error.what();
    }
    return "";
}

TEST(SectionFile, GivesBackWhatItHolds) {
    const SectionFile file = decode_sections(encode_sections(two_sections()));
    EXPECT_EQ(file.generation, 7u);
    EXPECT_EQ(file.sections, two_sections().sections);
    EXPECT_EQ(file.at(kOne).bytes, (Bytes{1, 2, 3}));
    EXPECT_EQ(file.at(kTwo, 3).bytes.size(), 1000u);
    EXPECT_TRUE(decode_sections(encode_sections({1, {}})).sections.empty());
}

TEST(SectionFile, IsWrittenWithoutACopyOfWhatItHolds) {
    const SectionFile file = two_sections();
    const SectionPieces in_pieces(file);
    for (const Section& section : file.sections)
        EXPECT_TRUE(std::ranges::any_of(in_pieces.pieces(), [&](const auto& piece) {
            return piece.data() == section.bytes.data() && piece.size() == section.bytes.size();
        }));
}

TEST(Hash128Stream, IsTheHashOfAllPiecesInARow) {
    Bytes bytes(5000);
    for (std::size_t i = 0; i < bytes.size(); ++i)
        bytes[i] = static_cast<std::uint8_t>(i * i >> 3);
    for (const std::size_t step : {1u, 16u, 239u, 240u, 241u, 1024u, 5000u}) {
        Hash128Stream stream;
        for (std::size_t at = 0; at < bytes.size(); at += step)
            stream.add(std::span(bytes).subspan(at, std::min(step, bytes.size() - at)));
        EXPECT_EQ(stream.result(), hash128_bytes(bytes)) << step;
    }
    EXPECT_EQ(Hash128Stream().result(), hash128_bytes({}));
}

TEST(SectionFile, EveryCutIsNoticed) {
    const Bytes whole = encode_sections(two_sections());
    for (std::size_t size = 0; size < whole.size(); ++size) {
        const std::string fault = fault_of(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)));
        EXPECT_NE(fault, "") << size << " of " << whole.size() << " bytes";
    }
    Bytes longer = whole;
    longer.push_back(0);
    EXPECT_NE(fault_of(longer), "");
}

TEST(SectionFile, EveryFlippedBitIsNoticed) {
    const Bytes whole = encode_sections(two_sections());
    for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
        Bytes flipped = whole;
        flipped[bit / 8] ^= static_cast<std::uint8_t>(1 << bit % 8);
        EXPECT_NE(fault_of(flipped), "") << "bit " << bit;
    }
}

TEST(SectionFile, SaysWhatIsWrong) {
    Bytes whole = encode_sections(two_sections());
    EXPECT_EQ(fault_of({}), "is no checkpoint");
    EXPECT_EQ(fault_of(Bytes(200, 'x')), "is no checkpoint");
    Bytes later = whole;
    later[4] = 9;
    EXPECT_EQ(fault_of(later), "has format 9, this program reads 1");
    EXPECT_NE(fault_of(Bytes(whole.begin(), whole.begin() + 500)).find("is cut off at 500 of "), std::string::npos);
    whole[100] ^= 1;
    EXPECT_EQ(fault_of(whole), "is damaged in its part TWO2");
    try {
        decode_sections(encode_sections(two_sections())).at(section_tag("ELSE"));
        FAIL();
    } catch (const FormatError& error) {
        EXPECT_STREQ(error.what(), "its part ELSE is missing");
    }
    try {
        decode_sections(encode_sections(two_sections())).at(kTwo);
        FAIL();
    } catch (const FormatError& error) {
        EXPECT_STREQ(error.what(), "its part TWO2 has version 3, this program reads 1");
    }
}

}  // namespace
}  // namespace treefarm
