// SPDX-License-Identifier: Apache-2.0
#include "common/metrics/z_test.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "common/base/error.h"
#include "common/base/random.h"
#include "common/metrics/normal_distribution.h"
#include "tests/support/small_image.h"

namespace treefarm {
namespace {

using test::image_of;
using test::kInf;
using test::kNan;

/// A standard normal number (Box and Muller 1958) for (pixel, channel).
double normal(std::uint64_t seed, std::size_t pixel, int channel) {
    const Draw d =
        draw({seed, static_cast<std::uint32_t>(pixel), 0}, static_cast<std::uint32_t>(channel), Stream::camera);
    const double u = (d[0] + 1.0) / 4294967296.0, v = d[1] / 4294967296.0;
    return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * 3.14159265358979323846 * v);
}

/// A smooth image.
RgbImage truth(int width, int height) {
    RgbImage image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const float v = 0.2f + 0.01f * static_cast<float>(x) + 0.005f * static_cast<float>(y);
            image.pixels[static_cast<std::size_t>(y * width + x)] = Rgb(v, 0.5f * v, 2.0f * v);
        }
    return image;
}

/// Standard deviation of a pixel's mean: a tenth of its value.
RgbImage variance_of(const RgbImage& image) {
    RgbImage variance = image;
    for (Rgb& v : variance.pixels)
        v = v * v * 0.01f;
    return variance;
}

RgbImage noisy(const RgbImage& mean, const RgbImage& variance, std::uint64_t seed, double scale = 1.0) {
    RgbImage image = mean;
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        for (int c = 0; c < 3; ++c)
            image.pixels[i][c] = static_cast<float>(
                scale * mean.pixels[i][c] + normal(seed, i, c) * std::sqrt(static_cast<double>(variance.pixels[i][c])));
    return image;
}

TEST(NormalTest, AgreesWithTables) {
    EXPECT_NEAR(two_sided_p(1.959964), 0.05, 1e-7);
    EXPECT_NEAR(two_sided_p(-3.0), 0.002699796, 1e-9);
    EXPECT_NEAR(critical_z(0.01), 2.575829, 1e-6);
    EXPECT_NEAR(sidak_level(0.01, 1), 0.01, 1e-15);
    EXPECT_NEAR(1.0 - std::pow(1.0 - sidak_level(0.01, 1000), 1000.0), 0.01, 1e-12);
}

TEST(ZTest, HandComputedBlock) {
    // Two pixels: differences 0.3 and 0.1 in red, variances 0.01 and 0.03: z = 0.4 / sqrt(0.04) = 2.
    const RgbImage b(2, 1, Rgb(1.0f));
    const RgbImage a = image_of(2, 1, {Rgb(1.3f, 1.0f, 1.0f), Rgb(1.1f, 1.0f, 1.0f)});
    const RgbImage v = image_of(2, 1, {Rgb(0.01f), Rgb(0.03f)});
    const BlockZTest blocks = block_z_test({a, b, &v});
    EXPECT_EQ(blocks.tests, 3u);
    EXPECT_NEAR(blocks.max_abs_z, 2.0, 1e-5);
    EXPECT_NEAR(blocks.image_z[0], 2.0, 1e-5);
    EXPECT_NEAR(blocks.mean_z2, 4.0 / 3.0, 1e-5);
    EXPECT_TRUE(blocks.pass);
    const PixelZTest pixels = pixel_z_test({a, b, &v}, {.pool_radius = 0});
    EXPECT_NEAR(pixels.max_abs_z, 3.0, 1e-5);
    EXPECT_NEAR(pixels.limit, critical_z(1.0 - std::sqrt(0.99)), 1e-9);
    EXPECT_EQ(pixels.accepted, 5u);
    EXPECT_FALSE(pixels.pass);
}

TEST(ZTest, GaussianNoisePassesAndItsSquareIsOne) {
    const RgbImage mean = truth(128, 128), variance = variance_of(mean);
    int failures = 0;
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        const RgbImage a = noisy(mean, variance, seed);
        const PixelZTest pixels = pixel_z_test({a, mean, &variance});
        const BlockZTest blocks = block_z_test({a, mean, &variance});
        EXPECT_TRUE(pixels.pass);
        EXPECT_NEAR(pixels.mean_z2, 1.0, 0.05);  // standard error 0.0064
        EXPECT_NEAR(blocks.mean_z2, 1.0, 0.5);   // 192 tests: standard error 0.1
        EXPECT_EQ(blocks.tests, 192u);
        failures += blocks.pass ? 0 : 1;
    }
    EXPECT_LE(failures, 2) << "each fails with a chance of 1 %";
}

TEST(ZTest, TwoPerCentOfBiasFailsInBlocksThoughPixelsHideIt) {
    const RgbImage mean = truth(128, 128), variance = variance_of(mean);
    const RgbImage a = noisy(mean, variance, 1, 1.02);
    const BlockZTest blocks = block_z_test({a, mean, &variance});
    EXPECT_FALSE(blocks.pass);
    EXPECT_GT(blocks.mean_z2, 5.0);  // each block's z is about 0.02 / (0.1 / 16) = 3.2
    EXPECT_GT(blocks.beyond_3, 50u);
    EXPECT_GT(blocks.image_z[0], 20.0);
    EXPECT_TRUE(pixel_z_test({a, mean, &variance}).pass);
}

TEST(ZTest, PixelsThatMissedRarePathsDoNotVouchForThemselves) {
    // One sample in 20 brings 20: of 32 samples a fifth of the pixels see none, are black, and report no variance.
    std::mt19937 engine(5);
    std::bernoulli_distribution bright(0.05);
    RgbImage image(64, 64), variance(64, 64);
    for (std::size_t p = 0; p < image.pixels.size(); ++p) {
        int hits = 0;
        for (int s = 0; s < 32; ++s)
            hits += bright(engine);
        image.pixels[p] = Rgb(20.0f * static_cast<float>(hits) / 32.0f);
        const float fraction = static_cast<float>(hits) / 32.0f;
        variance.pixels[p] = Rgb(400.0f * fraction * (1.0f - fraction) / 31.0f);
    }
    const RgbImage truth(64, 64, Rgb(1.0f));
    EXPECT_FALSE(pixel_z_test({image, truth, &variance}, {.pool_radius = 0}).pass);
    EXPECT_TRUE(pixel_z_test({image, truth, &variance}).pass);
    const RgbImage wrong(64, 64, Rgb(6.0f));
    EXPECT_FALSE(pixel_z_test({image, wrong, &variance}).pass);
}

TEST(ZTest, NoiseOfTheReferenceCounts) {
    const RgbImage mean = truth(128, 128), variance = variance_of(mean);
    const RgbImage a = noisy(mean, variance, 1), b = noisy(mean, variance, 2);
    EXPECT_NEAR(block_z_test({a, b, &variance}).mean_z2, 2.0, 0.7) << "as if the reference were exact";
    EXPECT_NEAR(block_z_test({a, b, &variance, &variance}).mean_z2, 1.0, 0.5);
}

TEST(ZTest, RoundingToHalfCounts) {
    const RgbImage mean = truth(64, 64);
    RgbImage rounded = mean;
    for (Rgb& pixel : rounded.pixels)
        for (int c = 0; c < 3; ++c)
            pixel[c] = static_cast<float>(Imath::half(pixel[c]));
    const RgbImage tiny(64, 64, Rgb(1e-12f));
    ZTestInput input{mean, rounded, &tiny};
    const ZTestOptions no_floor{.variance_floor = 0.0};
    EXPECT_GT(pixel_z_test(input, no_floor).mean_z2, 100.0);
    input.reference_half = true;
    EXPECT_LT(pixel_z_test(input, no_floor).mean_z2, 1.0);
    EXPECT_TRUE(block_z_test(input).pass);
}

TEST(ZTest, ACommonRelativeErrorIsNotAveragedAway) {
    const RgbImage mean = truth(64, 64), variance = variance_of(mean);
    RgbImage brighter = mean;
    for (Rgb& pixel : brighter.pixels)
        pixel *= 1.05f;
    const ZTestInput biased{brighter, mean, &variance, nullptr, false, false, 0.05};
    EXPECT_FALSE(block_z_test({brighter, mean, &variance}).pass);
    EXPECT_TRUE(block_z_test(biased).pass);
    EXPECT_LT(std::abs(block_z_test(biased).image_z[0]), 1.01);
}

TEST(ZTest, EqualAndBlackImagesPassWithoutDividingByZero) {
    const RgbImage black(20, 20), variance(20, 20);
    const PixelZTest pixels = pixel_z_test({black, black, &variance}, {.variance_floor = 0.0});
    const BlockZTest blocks = block_z_test({black, black, &variance});
    EXPECT_TRUE(pixels.pass);
    EXPECT_TRUE(blocks.pass);
    EXPECT_EQ(blocks.max_abs_z, 0.0);
    EXPECT_EQ(blocks.tests, 4u * 3u);
    const RgbImage light(20, 20, Rgb(0.1f));
    EXPECT_FALSE(block_z_test({light, black, &variance}).pass) << "a difference without noise is a bias";
}

TEST(ZTest, LeavesOutInvalidPixelsAndVariances) {
    RgbImage a(32, 32, Rgb(1.0f)), variance(32, 32, Rgb(0.01f));
    const RgbImage b = a;
    a.pixels[0] = Rgb(kNan);
    variance.pixels[1] = Rgb(kInf);
    variance.pixels[2] = Rgb(-1.0f, 0.0f, 0.0f);
    const PixelZTest pixels = pixel_z_test({a, b, &variance});
    EXPECT_EQ(pixels.invalid, 3u);
    EXPECT_EQ(pixels.tests, (1024u - 3u) * 3u);
    EXPECT_TRUE(block_z_test({a, b, &variance}).pass);
    const RgbImage nothing(32, 32, Rgb(kNan));
    EXPECT_FALSE(pixel_z_test({nothing, b, &variance}).pass) << "nothing tested is no pass";
    EXPECT_FALSE(block_z_test({nothing, b, &variance}).pass);
}

TEST(ZTest, RefusesDifferentSizes) {
    const RgbImage a(2, 2), b(2, 3);
    EXPECT_THROW(pixel_z_test({a, b}), InputError);
    EXPECT_THROW(block_z_test({a, a, &b}), InputError);
}

}  // namespace
}  // namespace treefarm
