// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "common/base/error.h"
#include "common/metrics/false_colour.h"
#include "common/metrics/flip/colour.h"
#include "common/metrics/flip/measure_flip.h"
#include "tests/support/direct_flip.h"
#include "tests/support/small_image.h"

namespace treefarm {
namespace {

using test::kInf;
using test::kNan;

/// colour(x, y, channel) in every pixel.
template <class Colour>
RgbImage image_of(int width, int height, const Colour& colour) {
    RgbImage image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < 3; ++c)
                image.pixels[static_cast<std::size_t>(y * width + x)][c] = static_cast<float>(colour(x, y, c));
    return image;
}

int pattern(int x, int y, int c) {
    return (7 * x + 13 * y + 5 * c) % 17;
}

struct Pair {
    RgbImage image, reference;
};

/// Colours in [0, 1], 24 x 17 pixels.
Pair ldr_pair() {
    return {image_of(24, 17, [](int x, int y, int c) { return (pattern(x, y, c) + x * y % 3) % 17 / 16.0; }),
            image_of(24, 17, [](int x, int y, int c) { return pattern(x, y, c) / 16.0; })};
}

/// Radiance from 1/32 to 1951.
Pair hdr_pair() {
    const auto truth = [](int x, int y, int c) {
        const double k = 1.0 + pattern(x, y, c);
        return k * k * (y < 8 ? x / 4.0 + 1.0 : 1.0 / 32.0);
    };
    return {image_of(24, 17, [&](int x, int y, int c) { return truth(x, y, c) * (1.0 + (x * y + c) % 5 / 8.0); }),
            image_of(24, 17, truth)};
}

double mean(const Plane& plane) {
    return std::accumulate(plane.values.begin(), plane.values.end(), 0.0) / static_cast<double>(plane.values.size());
}

double greatest(const Plane& plane) {
    return *std::max_element(plane.values.begin(), plane.values.end());
}

TEST(FlipColour, WhiteAndThePrimariesAreWhereCielabHasThem) {
    const Vec3 white = rgb_to_hunt_lab({1, 1, 1}), black = rgb_to_hunt_lab({0, 0, 0});
    EXPECT_NEAR(white.x, 100.0f, 1e-4f);
    EXPECT_NEAR(white.y, 0.0f, 1e-3f);
    EXPECT_NEAR(white.z, 0.0f, 1e-3f);
    EXPECT_NEAR(black.x, 0.0f, 1e-4f);
    const Vec3 green = rgb_to_hunt_lab({0, 1, 0});  // L 87.74, a -86.18, b 83.18 for sRGB under D65
    EXPECT_NEAR(green.x, 87.74f, 0.01f);
    EXPECT_NEAR(green.y, -86.18f * 0.8774f, 0.05f);
    EXPECT_NEAR(green.z, 83.18f * 0.8774f, 0.05f);
    const Vec3 opponent = rgb_to_opponent({1, 1, 1});
    EXPECT_NEAR(opponent.x, 100.0f, 1e-4f);
    EXPECT_NEAR(opponent.y, 0.0f, 1e-4f);
    EXPECT_NEAR(opponent.z, 0.0f, 1e-4f);
}

TEST(FlipColour, OpponentColoursReturn) {
    for (const Vec3& c : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.2f, 0.5f, 0.9f)}) {
        const Vec3 back = opponent_to_rgb(rgb_to_opponent(c));
        for (int i = 0; i < 3; ++i)
            EXPECT_NEAR(back[i], c[i], 1e-5f);
    }
}

TEST(FlipColour, CubeRootHasAFloatsDigits) {
    for (double x = 0.008; x < 1.001; x *= 1.0009)
        EXPECT_NEAR(static_cast<double>(cube_root(static_cast<float>(x))) / std::cbrt(x), 1.0, 3e-7) << x;
}

TEST(FlipKernels, OnePixelPerDegreeOrAThousandTheyAreNormalised) {
    EXPECT_NEAR(kDefaultPixelsPerDegree, 67.0206, 1e-4);
    for (const double ppd : {1.0, 10.0, kDefaultPixelsPerDegree, 1000.0}) {
        const auto sum = [](const Kernel& k) { return std::accumulate(k.begin(), k.end(), 0.0); };
        const SensitivityKernels s = sensitivity_kernels(ppd);
        EXPECT_NEAR(sum(s.y), 1.0, 1e-6) << ppd;
        EXPECT_NEAR(sum(s.cx), 1.0, 1e-6) << ppd;
        EXPECT_NEAR(std::hypot(sum(s.cz_narrow), sum(s.cz_wide)), 1.0, 1e-6) << ppd;
        const FeatureKernels f = feature_kernels(ppd);
        EXPECT_NEAR(sum(f.gaussian), 1.0, 1e-6) << ppd;
        const auto positive = [](const Kernel& k) {
            return std::accumulate(k.begin(), k.end(), 0.0, [](double a, float w) { return a + std::max(w, 0.0f); });
        };
        for (const Kernel& k : {f.first, f.second}) {
            EXPECT_NEAR(positive(k), 1.0, 1e-6) << ppd;
            EXPECT_NEAR(sum(k), 0.0, 1e-6) << ppd;
        }
    }
}

TEST(SeparableFilter, AgreesWithTheSumOverTheWindowBeyondTheBorderToo) {
    const Kernel across = {1, 2, 3, 4, 5}, down = {-1, 0.5f, 2};
    for (const auto& [width, height] : {std::pair(40, 9), std::pair(16, 1), std::pair(1, 4), std::pair(3, 2)}) {
        Plane plane(width, height);
        for (std::size_t i = 0; i < plane.values.size(); ++i)
            plane.values[i] = static_cast<float>(i * i % 23);
        const Plane result = filter_separable(plane, across, down);
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                float sum = 0.0f;
                for (int j = 0; j < 3; ++j)
                    for (int i = 0; i < 5; ++i)
                        sum += across[static_cast<std::size_t>(i)] * down[static_cast<std::size_t>(j)] *
                               plane.row(std::clamp(
                                   y + j - 1, 0,
                                   height - 1))[static_cast<std::size_t>(std::clamp(x + i - 2, 0, width - 1))];
                ASSERT_EQ(result.row(y)[static_cast<std::size_t>(x)], sum) << x << ", " << y;
            }
    }
}

TEST(Flip, FlatImagesDifferByTheirColoursAlone) {
    // Black and white are 100 apart; green and blue, the greatest distance, 203.30 (L 87.74 and 32.30; a, b times
    // L / 100: (-75.61, 72.98) and (25.58, -34.84)).
    const double most = std::pow(203.30, 0.7);
    const double expected = 0.95 + 0.05 * (std::pow(100.0, 0.7) - 0.4 * most) / (0.6 * most);
    for (const auto& [width, height] : {std::pair(1, 1), std::pair(3, 2), std::pair(40, 30)}) {
        const RgbImage black(width, height), white(width, height, Rgb(1.0f));
        for (const float value : flip(white, black).values)
            EXPECT_NEAR(value, expected, 1e-4);
        for (const float value : flip(image_of(width, height, [](int, int, int c) { return c == 1; }),
                                      image_of(width, height, [](int, int, int c) { return c == 2; }))
                                     .values)
            EXPECT_NEAR(value, 1.0, 1e-4);
        for (const float value : flip(white, white).values)
            EXPECT_EQ(value, 0.0f);
    }
}

TEST(Flip, AgreesWithTwoDimensionalFilters) {
    const Pair pair = ldr_pair();
    for (const double ppd : {kDefaultPixelsPerDegree, 20.0}) {
        const Plane map = flip(pair.image, pair.reference, ppd);
        for (const auto& [x, y] : {std::pair(0, 0), std::pair(23, 16), std::pair(12, 8), std::pair(5, 11)})
            EXPECT_NEAR(map.row(y)[static_cast<std::size_t>(x)], direct_flip(pair.image, pair.reference, x, y, ppd),
                        1e-5)
                << x << ", " << y << ", " << ppd;
    }
}

TEST(Flip, DoesNotCareWhichIsTheReference) {
    const Pair pair = ldr_pair();
    EXPECT_EQ(flip(pair.image, pair.reference).values, flip(pair.reference, pair.image).values);
}

TEST(Flip, AgreesWithTheAuthorsProgram) {
    // Figures that NVlabs/flip gave (commit 1eb247c, C++): mean, maximum, and the pixels 0, 100, ..., 400 of each map.
    const auto expect = [](const Plane& map, double mean_value, double max, const std::array<double, 4>& pixels) {
        EXPECT_NEAR(mean(map), mean_value, 1e-5);
        EXPECT_NEAR(greatest(map), max, 1e-5);
        for (std::size_t i = 0; i < 4; ++i)
            EXPECT_NEAR(map.values[100 * i], pixels[i], 1e-5) << i;
    };
    const Pair ldr = ldr_pair(), hdr = hdr_pair();
    expect(flip(ldr.image, ldr.reference), 0.2322347, 0.6317306, {0.0865652, 0.1691437, 0.3075362, 0.2103074});
    expect(flip(ldr.image, ldr.reference, 30.0), 0.2911881, 0.9712665, {0.0960077, 0.3026750, 0.3019087, 0.0964345});
    const ExposureRange range = exposure_range(hdr.image, hdr.reference);
    EXPECT_NEAR(range.start, -9.518686, 1e-4);
    EXPECT_NEAR(range.stop, -1.818247, 1e-4);
    EXPECT_EQ(range.count, 8);
    expect(hdr_flip(hdr.image, hdr.reference, range), 0.1943601, 0.2872827,
           {0.2047425, 0.2033930, 0.1689304, 0.2114876});
    expect(hdr_flip(hdr.image, hdr.reference, range, 30.0), 0.2295052, 0.4415817,
           {0.2268479, 0.2071580, 0.2724906, 0.1666705});
}

TEST(HdrFlip, ToneCurve) {
    EXPECT_EQ(tone_map(0.0), 0.0f);
    EXPECT_EQ(tone_map(-100.0), 0.0f) << "the square of a negative number is no light";
    EXPECT_NEAR(tone_map(1.0), (0.9036 + 0.018) / (0.8748 + 0.354 + 0.14), 1e-6);
    EXPECT_EQ(tone_map(1e300), 1.0f);
}

TEST(HdrFlip, ExposuresShowTheBrightestAndTheMedianAlike) {
    RgbImage reference(5, 1, Rgb(0.25f));
    reference.pixels[0] = Rgb(64.0f);
    reference.pixels[4] = Rgb(0.0f);
    const ExposureRange range = exposure_range(reference, reference);
    EXPECT_NEAR(tone_map(64.0 * std::exp2(range.start)), 0.85, 1e-5);
    EXPECT_NEAR(tone_map(0.25 * std::exp2(range.stop)), 0.85, 1e-5);
    EXPECT_EQ(range.count, 8);
    reference.pixels[1] = reference.pixels[2] = Rgb(0.0f);  // most are black
    EXPECT_NEAR(exposure_range(reference, reference).stop, range.start, 1e-9) << "the upper median of 0.25 and 64";
    const RgbImage black(5, 1);
    EXPECT_EQ(exposure_range(reference, black).start, range.start) << "a black reference leaves it to the image";
    EXPECT_EQ(exposure_range(black, black).stop, 0.0);
    reference.pixels[2] = Rgb(kInf);
    EXPECT_NEAR(exposure_range(black, reference).start, range.start, 1e-9) << "infinite pixels do not count";
}

TEST(HdrFlip, TheUnitOfRadianceIsOfNoMatter) {
    Pair pair = hdr_pair();
    const Plane map = measure_flip(pair.image, pair.reference).hdr_map;
    for (RgbImage* image : {&pair.image, &pair.reference})
        for (Rgb& c : image->pixels)
            c *= 1024.0f;
    const Plane scaled = measure_flip(pair.image, pair.reference).hdr_map;
    for (std::size_t i = 0; i < map.values.size(); ++i)
        EXPECT_NEAR(map.values[i], scaled.values[i], 1e-5f);
}

TEST(MeasureFlip, FiguresOfAMap) {
    Plane map(5, 1);
    map.values = {0.1f, 0.5f, kNan, 0.2f, 0.3f};
    const FlipFigures f = flip_figures(map);
    EXPECT_NEAR(f.mean, 1.1 / 4.0, 1e-7);
    EXPECT_EQ(f.max, 0.5f);
    EXPECT_EQ(f.weighted_median, 0.3f) << "0.1 + 0.2 is less than half of 1.1, 0.6 more";
    EXPECT_EQ(flip_figures(Plane(2, 1)).weighted_median, 0.0);
    map.values.assign(5, kNan);
    EXPECT_TRUE(std::isnan(flip_figures(map).mean));
}

TEST(MeasureFlip, InvalidPixelsAreLeftOutAndDisturbNoOther) {
    Pair pair = hdr_pair();
    pair.image = pair.reference;
    pair.image.pixels[30] = Rgb(kNan, 1.0f, 1.0f);
    pair.image.pixels[31] = Rgb(kInf);
    pair.reference.pixels[60] = Rgb(kNan);
    const FlipMetrics m = measure_flip(pair.image, pair.reference);
    int left_out = 0;
    for (std::size_t i = 0; i < m.hdr_map.values.size(); ++i)
        if (std::isnan(m.hdr_map.values[i]))
            ++left_out;
        else
            EXPECT_EQ(m.hdr_map.values[i], 0.0f) << i;
    EXPECT_EQ(left_out, 3);
    EXPECT_EQ(m.hdr.mean, 0.0);
    EXPECT_EQ(m.ldr.max, 0.0);
    const RgbImage nothing(3, 3, Rgb(kNan));
    EXPECT_TRUE(std::isnan(measure_flip(nothing, nothing).hdr.mean));
}

TEST(MeasureFlip, BlackNegativeAndExtremeImagesGiveNumbers) {
    const RgbImage black(3, 2), negative(3, 2, Rgb(-5.0f)), grey(3, 2, Rgb(0.5f));
    EXPECT_EQ(measure_flip(black, black).hdr.mean, 0.0);
    EXPECT_EQ(measure_flip(negative, black).hdr.mean, 0.0) << "negative light shows as black";
    EXPECT_EQ(measure_flip(grey, black).hdr.mean, measure_flip(black, grey).hdr.mean);
    EXPECT_GT(measure_flip(grey, black).hdr.mean, 0.9);
    RgbImage extreme(3, 2, Rgb(1e-38f));
    extreme.pixels[1] = Rgb(3e38f);
    const FlipMetrics m = measure_flip(grey, extreme);
    EXPECT_TRUE(m.hdr.mean >= 0.0 && m.hdr.max <= 1.0);
    EXPECT_GT(m.exposures.count, 200);
    EXPECT_THROW(measure_flip(RgbImage(2, 3), RgbImage(3, 2)), InputError);
    EXPECT_THROW(measure_flip(RgbImage(), RgbImage()), InputError);
}

TEST(FalseColour, GetsBrighterInStepAndMarksWhatIsNoNumber) {
    EXPECT_EQ(cubehelix(0.0f), Rgb(0.0f));
    EXPECT_NEAR(max_component(cubehelix(1.0f) - Rgb(1.0f)), 0.0f, 1e-5f);
    Plane map(3, 1);
    map.values = {0.5f, kNan, 1.5f};
    const RgbImage image = false_colour(map);
    // Halfway: angle 2 pi (1/6 - 3/4), amplitude 1/8; display values 0.6275, 0.4750, 0.2864 are decoded.
    EXPECT_NEAR(image.pixels[0].x, std::pow((0.6275 + 0.055) / 1.055, 2.4), 1e-3);
    EXPECT_EQ(image.pixels[1], Rgb(1.0f, 0.0f, 1.0f));
    EXPECT_NEAR(image.pixels[2].y, 1.0f, 1e-5f);
}

}  // namespace
}  // namespace treefarm
