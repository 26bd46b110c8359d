// SPDX-License-Identifier: Apache-2.0
// Splats are exact sums: any cut and any order give the same bits, and a codec that believes nothing.
#include "common/film/splat_film.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

namespace treefarm {
namespace {

constexpr SplatShape kShape{64, -10};

struct Splat {
    std::uint32_t pixel, sample;
    Rgb value;
    Draw bits;
};

std::vector<Splat> random_splats(std::size_t count, unsigned seed) {
    std::mt19937 engine(seed);
    std::exponential_distribution<float> value;
    std::vector<Splat> splats;
    for (std::size_t k = 0; k < count; ++k) {
        const auto pixel = static_cast<std::uint32_t>(engine() % kShape.pixels);
        const Rgb v(value(engine), k % 3 == 0 ? 0.0f : value(engine), 1e-4f * value(engine));
        splats.push_back({pixel,
                          static_cast<std::uint32_t>(engine()),
                          v,
                          {static_cast<std::uint32_t>(engine()), static_cast<std::uint32_t>(engine()),
                           static_cast<std::uint32_t>(engine()), static_cast<std::uint32_t>(engine())}});
    }
    return splats;
}

SplatSums sums_of(std::span<const Splat> splats, const SplatShape& shape = kShape) {
    SplatLog log;
    log.begin(shape);
    for (const Splat& s : splats)
        log.add(s.pixel, s.sample, s.value, s.bits);
    SplatSums sums(shape);
    sums.add(log.summed(), log.caps());
    return sums;
}

TEST(Splats, AnyCutAndAnyOrderGiveTheSameBits) {
    const std::vector<Splat> splats = random_splats(150'000, 1);  // more than a log holds before it is summed up
    const SplatSums whole = sums_of(splats);
    EXPECT_FALSE(whole.at(0, 0).empty());
    for (unsigned order = 0; order < 20; ++order) {
        std::mt19937 engine(order);
        std::vector<Bytes> parts;
        for (std::size_t first = 0; first < splats.size();) {
            const std::size_t count = std::min<std::size_t>(1 + engine() % 50'000, splats.size() - first);
            parts.push_back(sums_of(std::span(splats).subspan(first, count)).encode());
            first += count;
        }
        std::shuffle(parts.begin(), parts.end(), engine);
        SplatSums merged(kShape);
        for (const Bytes& part : parts)
            merged.merge_encoded(part);
        ASSERT_EQ(merged, whole) << order;
    }
}

TEST(Splats, ALogHasOneEntryForEachHalfOfAPixelInOrder) {
    SplatLog log;
    log.begin(kShape);
    for (const Splat& s : random_splats(150'000, 4))
        log.add(s.pixel, s.sample, s.value, s.bits);
    const auto entries = log.summed();
    EXPECT_EQ(entries.size(), 2u * kShape.pixels);
    for (std::size_t k = 0; k < entries.size(); ++k)
        EXPECT_EQ(entries[k].slot, k);
    log.begin(kShape);
    EXPECT_TRUE(log.empty());
    EXPECT_TRUE(log.summed().empty());
}

constexpr SplatShape kChains{kShape.pixels, 0, true};

/// Sums of chains as `random_splats` gives them, each of a hundred splats, in this order.
SplatSums sums_of_chains(std::span<const Splat> splats, std::span<const std::size_t> order) {
    constexpr std::size_t kSteps = 100;
    SplatSums sums(kChains);
    SplatLog log;
    log.begin(kChains);
    for (const std::size_t chain : order) {
        for (const Splat& s : splats.subspan(chain * kSteps, kSteps))
            log.add(s.pixel % 3, static_cast<std::uint32_t>(chain), s.value, s.bits);
        log.end_chain();
        if (chain % 7 != 0) continue;  // the end of a unit
        sums.add(log.summed(), log.caps());
        log.begin(kChains);
    }
    sums.add(log.summed(), log.caps());
    return sums;
}

TEST(Splats, ChainsInAnyOrderAndUnitsGiveTheSameBits) {
    const std::vector<Splat> splats = random_splats(20'000, 5);
    std::vector<std::size_t> order(200);
    std::iota(order.begin(), order.end(), 0u);
    const SplatSums whole = sums_of_chains(splats, order);
    std::mt19937 engine(6);
    for (int k = 0; k < 20; ++k) {
        std::shuffle(order.begin(), order.end(), engine);
        ASSERT_EQ(sums_of_chains(splats, order), whole);
    }
    SplatSums merged(kChains);
    merged.merge_encoded(whole.encode());
    EXPECT_EQ(merged, whole);
}

TEST(Splats, SquaresOfChainsAreOfAllThatOneBringsToAPixel) {
    SplatLog log;
    log.begin({2, 0, true});
    const auto chain = [&](std::uint32_t number, std::initializer_list<float> values) {
        for (const float value : values)
            log.add(1, number, Rgb(value * 1024, 0.0f, value * 0x1p40f), {});
        log.end_chain();
    };
    chain(0, {3, 4, 5});
    chain(2, {7, 0.25f});
    chain(4, {});
    const auto entries = log.summed();
    ASSERT_EQ(entries.size(), 1u);
    EXPECT_EQ(entries[0].moments.sum[0], 19u * 1024 + 256);
    EXPECT_EQ(entries[0].moments.square[0], 12u * 12 + 7 * 7);
    EXPECT_EQ(entries[0].moments.square[1], 0u);
    EXPECT_EQ(entries[0].moments.square[2], kMostSplatSum) << "saturates";
}

TEST(Splats, RoundingIsUnbiased) {
    SplatLog log;
    log.begin({1, 0});
    std::mt19937 engine(2);
    constexpr std::uint32_t kCount = 200'000;
    for (std::uint32_t k = 0; k < kCount; ++k)
        log.add(0, 0, Rgb(0.3f, 2.75f, 500.0f),
                {static_cast<std::uint32_t>(engine()), static_cast<std::uint32_t>(engine()),
                 static_cast<std::uint32_t>(engine()), static_cast<std::uint32_t>(engine())});
    const SplatMoments moments = log.summed()[0].moments;
    const auto expect_mean = [&](std::uint64_t sum, double mean) {
        const double fraction = mean - std::floor(mean);
        const double deviation = std::sqrt(fraction * (1 - fraction) / kCount);
        EXPECT_NEAR(static_cast<double>(sum) / kCount, mean, 4 * deviation + 1e-9);
    };
    expect_mean(moments.sum[0], static_cast<double>(0.3f));
    expect_mean(moments.sum[1], 2.75);
    expect_mean(moments.sum[2], 500.0);
    expect_mean(moments.square[2], 250'000.0 / (1 << kSquareBits));
}

TEST(Splats, ExponentGivesTheMeanElevenBits) {
    for (const double mean : {1e-30, 0.3, 1.0, 7.0, 1e20}) {
        const double quanta = std::ldexp(mean, -splat_exponent(mean));
        EXPECT_GE(quanta, 1024);
        EXPECT_LT(quanta, 2048);
    }
    EXPECT_EQ(splat_exponent(0.0), 0) << "nothing was splatted";
    EXPECT_EQ(splat_exponent(1e-300), -kMostSplatExponent);
}

TEST(Splats, CapsAreCountedAndTheDoorIsShut) {
    SplatLog log;
    log.begin({2, 0});
    const Draw bits{};
    log.add(0, 0, Rgb(0x1p41f, 1.0f, 0.0f), bits);
    log.add(1, 1, Rgb(0x1p40f), bits);
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -1.0f})
        log.add(1, 1, Rgb(1.0f, bad, 1.0f), bits);
    EXPECT_EQ(log.caps(), (SplatCaps{1, 3}));
    const auto entries = log.summed();
    ASSERT_EQ(entries.size(), 2u);
    EXPECT_EQ(entries[0].moments.sum, (std::array<std::uint64_t, 3>{1ull << 40, 1, 0}));
    EXPECT_EQ(entries[1].slot, 3u);
    EXPECT_EQ(entries[1].moments.square[0], 1ull << 60);
    SplatSums sums(SplatShape{2, 0});
    sums.add(entries, log.caps());
    SplatSums merged(SplatShape{2, 0});
    merged.merge_encoded(sums.encode());
    EXPECT_EQ(merged.caps(), log.caps()) << "they travel";
    EXPECT_THROW(SplatSums(SplatShape{1, 0}).add(entries, {}), RunError);
}

TEST(Splats, SumsStopAtTheirLimitInAnyOrder) {
    SplatLog::Entry large{0, {}}, small{0, {}};
    large.moments.sum = {kMostSplatSum - 10, kMostSplatSum, 5};
    small.moments.sum = {7, 1, 1};
    const auto sum = [&](const std::vector<SplatLog::Entry>& entries) {
        SplatSums sums(SplatShape{1, 0});
        for (const SplatLog::Entry& entry : entries)
            sums.add(std::span(&entry, 1), {});
        return sums;
    };
    const SplatSums full = sum({large, small, small, large});
    EXPECT_EQ(full.at(0, 0).sum, (std::array<std::uint64_t, 3>{kMostSplatSum, kMostSplatSum, 12}));
    EXPECT_EQ(full.saturated(), 2u);
    EXPECT_EQ(full, sum({small, large, large, small}));
    EXPECT_EQ(sum({large, small}).at(0, 0).sum[0], kMostSplatSum - 3);
    EXPECT_EQ(sum({large, large}).at(0, 0).sum[1], kMostSplatSum) << "two limits make 2^64";
}

/// What the codec refuses changes nothing.
class SplatCodec : public ::testing::Test {
  protected:
    void expect_refused(const Bytes& bytes, const char* why) {
        SplatSums sums = whole_;
        EXPECT_THROW(sums.merge_encoded(bytes), FormatError) << why;
        EXPECT_EQ(sums, whole_) << why;
    }

    /// Encoded by hand: caps, then the entries of both halves.
    static Bytes encoded(std::uint64_t pixels, int exponent, std::uint64_t capped,
                         const std::vector<std::array<std::uint64_t, 7>>& even) {
        ByteWriter out;
        out.put_varint(pixels);
        out.put(static_cast<std::int16_t>(exponent));
        out.put_varint(capped);
        out.put_varint(0);
        out.put_varint(even.size());
        for (const auto& entry : even)
            for (const std::uint64_t value : entry)
                out.put_varint(value);
        out.put_varint(0);
        return out.take();
    }

    const SplatSums whole_ = sums_of(random_splats(1000, 3));
};

TEST_F(SplatCodec, TakesWhatFits) {
    SplatSums sums(kShape);
    sums.merge_encoded(encoded(64, -10, 3, {{0, 1, 0, 0, 0, 0, 0}, {62, 0, 0, 0, 0, 0, kMostSplatSum}}));
    EXPECT_EQ(sums.at(0, 0).sum[0], 1u);
    EXPECT_EQ(sums.at(63, 0).square[2], kMostSplatSum);
    EXPECT_EQ(sums.caps().capped, 3u);
    EXPECT_EQ(SplatSums(kShape).encode().size(), 7u) << "of no splats";
}

TEST_F(SplatCodec, RefusesWhatCannotBe) {
    expect_refused(encoded(65, -10, 0, {}), "another film");
    expect_refused(encoded(64, -11, 0, {}), "another quantum");
    expect_refused(encoded(64, -10, ~0ull, {}), "too many capped");
    expect_refused(encoded(64, -10, 0, {{64, 1, 0, 0, 0, 0, 0}}), "a splat beyond the film");
    expect_refused(encoded(64, -10, 0, {{63, 1, 0, 0, 0, 0, 0}, {0, 1, 0, 0, 0, 0, 0}}), "the next one");
    expect_refused(encoded(64, -10, 0, {{~0ull, 1, 0, 0, 0, 0, 0}}), "the last skip");
    expect_refused(encoded(64, -10, 0, {{3, 0, 0, 0, 0, 0, 0}}), "an empty pixel");
    expect_refused(encoded(64, -10, 0, {{3, kMostSplatSum + 1, 0, 0, 0, 0, 0}}), "a sum above the limit");
    Bytes bytes = whole_.encode();
    for (std::size_t length = 0; length < bytes.size(); ++length)
        expect_refused({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length)}, "cut short");
    bytes.push_back(0);
    expect_refused(bytes, "more behind it");
}

}  // namespace
}  // namespace treefarm
