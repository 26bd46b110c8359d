// SPDX-License-Identifier: Apache-2.0
// Film atoms: any cut of the work gives the same bits.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "common/base/error.h"
#include "common/film/pass_film.h"

namespace treefarm {
namespace {

Rgb random_sample(std::mt19937& engine) {
    std::exponential_distribution<float> value(1.0f);
    return {value(engine), value(engine), value(engine)};
}

/// The estimates of one pixel's blocks.
std::vector<PixelEstimate> make_blocks(std::uint32_t spp, unsigned seed) {
    std::mt19937 engine(seed);
    std::vector<PixelEstimate> blocks((spp + kBlockSamples - 1) / kBlockSamples);
    for (std::uint32_t s = 0; s < spp; ++s)
        blocks[s / kBlockSamples].add(s, random_sample(engine));
    return blocks;
}

bool same_bits(const PixelEstimate& a, const PixelEstimate& b) {
    for (int h = 0; h < 2; ++h)
        if (a.half[h].n != b.half[h].n || a.half[h].mean != b.half[h].mean || a.half[h].m2 != b.half[h].m2)
            return false;
    return true;
}

TEST(Moments, MatchTheTwoPassFormulas) {
    std::mt19937 engine(7);
    std::vector<Rgb> samples(1000);
    for (Rgb& s : samples)
        s = random_sample(engine);
    Moments m;
    for (const Rgb& s : samples)
        m.add(s);
    for (int c = 0; c < 3; ++c) {
        double mean = 0, m2 = 0;
        for (const Rgb& s : samples)
            mean += s[c];
        mean /= 1000;
        for (const Rgb& s : samples)
            m2 += (s[c] - mean) * (s[c] - mean);
        EXPECT_NEAR(m.mean[c], mean, 1e-12);
        EXPECT_NEAR(m.sample_variance()[c], m2 / 999, 1e-11);
    }
}

TEST(Moments, OfFewSamplesHaveNoVariance) {
    Moments m;
    EXPECT_EQ(m.sample_variance(), Rgb64(0.0));
    m.add(Rgb(3.0f));
    EXPECT_EQ(m.sample_variance(), Rgb64(0.0));
    EXPECT_EQ(m.mean, Rgb64(3.0));
}

TEST(Moments, SplitAndMergedEqualTheWhole) {
    std::mt19937 engine(3);
    Moments whole, first, second;
    for (int i = 0; i < 777; ++i) {
        const Rgb s = random_sample(engine);
        whole.add(s);
        (i < 200 ? first : second).add(s);
    }
    const Moments merged = Moments::merge(first, second);
    EXPECT_EQ(merged.n, whole.n);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(merged.mean[c], whole.mean[c], 1e-12);
        EXPECT_NEAR(merged.m2[c], whole.m2[c], 1e-9);
    }
}

TEST(ReduceBlocks, AlignedRunsAreSubtrees) {
    for (const std::uint32_t spp : {1u, 64u, 65u, 68u, 640u, 1000u}) {
        const std::vector<PixelEstimate> blocks = make_blocks(spp, spp);
        const PixelEstimate whole = reduce_blocks(blocks);
        EXPECT_EQ(whole.half[0].n + whole.half[1].n, spp);
        for (std::size_t run = 1; run <= 16; run *= 2) {
            std::vector<PixelEstimate> chunks;
            for (std::size_t b = 0; b < blocks.size(); b += run)
                chunks.push_back(reduce_blocks(std::span(blocks).subspan(b, std::min(run, blocks.size() - b))));
            EXPECT_TRUE(same_bits(reduce_blocks(chunks), whole)) << spp << " spp in runs of " << run;
        }
    }
}

TEST(PassFilm, IsTheSameForAnyOrderAndCut) {
    constexpr int kWidth = 7, kHeight = 5;
    constexpr std::uint32_t kChunks = 3, kSpp = kChunks * kBlockSamples;
    std::vector<std::vector<PixelEstimate>> truth;
    for (unsigned p = 0; p < kWidth * kHeight; ++p)
        truth.push_back(make_blocks(kSpp, p));

    for (unsigned seed = 0; seed < 4; ++seed) {
        std::vector<WorkUnit> units;
        const auto step = static_cast<std::uint16_t>(seed + 2);
        for (std::uint16_t y = 0; y < kHeight; y = static_cast<std::uint16_t>(y + step))
            for (std::uint16_t x = 0; x < kWidth; x = static_cast<std::uint16_t>(x + step))
                for (std::uint32_t c = 0; c < kChunks; ++c)
                    units.push_back({0, x, y, static_cast<std::uint16_t>(std::min<int>(x + step, kWidth)),
                                     static_cast<std::uint16_t>(std::min<int>(y + step, kHeight)), c});
        std::mt19937 engine(seed);
        std::shuffle(units.begin(), units.end(), engine);
        PassFilm film(kWidth, kHeight, kChunks);
        for (const WorkUnit& unit : units) {
            EXPECT_FALSE(film.complete());
            std::vector<PixelEstimate> pixels;
            for (unsigned y = unit.y0; y < unit.y1; ++y)
                for (unsigned x = unit.x0; x < unit.x1; ++x)
                    pixels.push_back(truth[y * kWidth + x][unit.chunk]);
            film.add(unit, pixels);
        }
        ASSERT_TRUE(film.complete());
        for (unsigned p = 0; p < truth.size(); ++p)
            EXPECT_TRUE(same_bits(film.pixels()[p], reduce_blocks(truth[p]))) << "pixel " << p << ", cut " << seed;
    }
}

TEST(PassFilm, GoesOnFromWhatHadCome) {
    constexpr int kWidth = 7, kHeight = 5;
    for (const std::uint32_t chunks : {1u, 3u}) {
        std::vector<WorkUnit> units = cut_tiles(0, chunks, kWidth, kHeight, 2);
        std::mt19937 engine(chunks);
        std::shuffle(units.begin(), units.end(), engine);
        const auto pixels_of = [&](const WorkUnit& unit) {
            std::vector<PixelEstimate> pixels;
            for (unsigned y = unit.y0; y < unit.y1; ++y)
                for (unsigned x = unit.x0; x < unit.x1; ++x)
                    pixels.push_back(make_blocks(chunks * kBlockSamples, y * kWidth + x)[unit.chunk]);
            return pixels;
        };
        PassFilm whole(kWidth, kHeight, chunks);
        for (const WorkUnit& unit : units)
            whole.add(unit, pixels_of(unit));
        for (std::size_t stop = 0; stop <= units.size(); stop += 5) {
            PassFilm first(kWidth, kHeight, chunks), second(kWidth, kHeight, chunks);
            DoneWork done(kWidth, kHeight, chunks);
            for (std::size_t k = 0; k < stop; ++k) {
                first.add(units[k], pixels_of(units[k]));
                done.add(units[k]);
            }
            Bytes bytes = first.encode(done);
            second.restore(done, bytes);
            EXPECT_EQ(second.encode(done), bytes);
            for (std::size_t k = stop; k < units.size(); ++k)
                second.add(units[k], pixels_of(units[k]));
            ASSERT_TRUE(second.complete());
            for (std::size_t p = 0; p < whole.pixels().size(); ++p)
                EXPECT_TRUE(same_bits(second.pixels()[p], whole.pixels()[p])) << "pixel " << p << ", " << stop;
            bytes.push_back(0);
            PassFilm third(kWidth, kHeight, chunks);
            EXPECT_THROW(third.restore(done, bytes), FormatError);
            EXPECT_THROW(third.restore(DoneWork(kWidth, kHeight, chunks + 1), {}), FormatError);
        }
    }
}

TEST(PassFilm, RefusesUnitsThatDoNotFit) {
    PassFilm film(4, 4, 1);
    const std::vector<PixelEstimate> pixels(4);
    EXPECT_THROW(film.add({0, 0, 0, 5, 1, 0}, std::vector<PixelEstimate>(5)), FormatError);
    EXPECT_THROW(film.add({0, 2, 0, 2, 2, 0}, {}), FormatError);
    EXPECT_THROW(film.add({0, 0, 0, 4, 1, 1}, pixels), FormatError);
    EXPECT_THROW(film.add({0, 0, 0, 4, 2, 0}, pixels), FormatError);
    film.add({0, 0, 0, 4, 4, 0}, std::vector<PixelEstimate>(16));
    EXPECT_EQ(film.take_pixels().size(), 16u);
    EXPECT_THROW(film.add({0, 0, 0, 4, 1, 0}, pixels), FormatError) << "its pixels are gone";
}

}  // namespace
}  // namespace treefarm
