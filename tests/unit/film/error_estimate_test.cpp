// SPDX-License-Identifier: Apache-2.0
// What an image says about its own error, on samples whose truth is known.
#include "common/film/error_estimate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace treefarm {
namespace {

constexpr int kSize = 48;
constexpr double kMean = 1.0;

/// Deviation of the samples of a pixel: a quiet left half, a loud right one, a very loud corner.
double deviation(int x, int y) {
    if (x < kSize / 2) return 0.1;
    return y < 6 && x > kSize - 6 ? 4.0 : 1.0;
}

enum class Noise { gaussian, skewed };

std::vector<PassResult> synthetic_passes(const std::vector<std::uint32_t>& spp, Noise noise, unsigned seed) {
    std::mt19937 engine(seed);
    std::normal_distribution<double> gaussian;
    std::exponential_distribution<double> exponential;
    std::vector<PassResult> passes;
    std::uint32_t before = 0;
    for (const std::uint32_t n : spp) {
        PassResult pass{n, before, std::vector<PixelEstimate>(kSize * kSize)};
        for (int p = 0; p < kSize * kSize; ++p)
            for (std::uint32_t s = 0; s < n; ++s) {
                const double z = noise == Noise::gaussian ? gaussian(engine) : exponential(engine) - 1;
                const double value = kMean + deviation(p % kSize, p / kSize) * z;
                pass.pixels[static_cast<std::size_t>(p)].add(before + s, Rgb(static_cast<float>(value)));
            }
        passes.push_back(std::move(pass));
        before += n;
    }
    return passes;
}

double true_mse(const CombinedImage& image) {
    double sum = 0;
    for (const Rgb64& m : image.mean)
        sum += (m.x - kMean) * (m.x - kMean);
    return sum / static_cast<double>(image.mean.size());
}

struct Trial {
    double ratio = 0;  ///< mean estimated over mean true squared error
    int covered = 0;   ///< of 100
    double relative_width = 0;
};

Trial try_hundred(const std::vector<std::uint32_t>& spp, Noise noise, Combination method, bool guided) {
    double estimated = 0, truth = 0;
    Trial trial;
    for (unsigned seed = 0; seed < 100; ++seed) {
        const CombinedImage image = combine_passes(synthetic_passes(spp, noise, seed), method, guided);
        const ErrorEstimate error = estimate_error(image, seed);
        const double mse = true_mse(image);
        estimated += error.mse();
        truth += mse;
        trial.covered += error.low <= std::sqrt(mse) && std::sqrt(mse) <= error.high;
        trial.relative_width += (error.high - error.low) / error.rmse / 100;
    }
    trial.ratio = estimated / truth;
    return trial;
}

void expect_honest(const Trial& trial) {
    EXPECT_GE(trial.ratio, 0.95);
    EXPECT_LE(trial.ratio, 1.05);
    EXPECT_GE(trial.covered, 90);
    EXPECT_LT(trial.covered, 100) << "an interval that never fails is too wide";
}

TEST(ErrorEstimate, IsHonestForEveryCombination) {
    expect_honest(try_hundred({8}, Noise::gaussian, Combination::fixed, false));
    expect_honest(try_hundred({1, 2, 4, 9}, Noise::gaussian, Combination::fixed, false));
    expect_honest(try_hundred({1, 2, 4, 9}, Noise::gaussian, Combination::fixed, true));
    expect_honest(try_hundred({1, 2, 4, 8, 17}, Noise::gaussian, Combination::inverse_variance, true));
    expect_honest(try_hundred({4, 8}, Noise::gaussian, Combination::last, true));
}

TEST(ErrorEstimate, IsHonestForSkewedSamples) {
    expect_honest(try_hundred({4, 8, 16}, Noise::skewed, Combination::inverse_variance, true));
    expect_honest(try_hundred({1, 3, 9}, Noise::skewed, Combination::fixed, false));
}

TEST(ErrorEstimate, KnowsASingleLoudSample) {
    // A first pass of one sample, much louder than what follows: all that tells is its distance from the others.
    double estimated = 0, truth = 0;
    for (unsigned seed = 0; seed < 20; ++seed) {
        std::vector<PassResult> passes = synthetic_passes({1, 15}, Noise::gaussian, seed);
        for (PixelEstimate& pixel : passes[0].pixels) {
            const double value = kMean + 20 * (pixel.half[0].mean.x - kMean);
            pixel = {};
            pixel.add(0, Rgb(static_cast<float>(value)));
        }
        const CombinedImage image = combine_passes(passes, Combination::fixed, true);
        estimated += estimate_error(image, 0).mse();
        truth += true_mse(image);
    }
    EXPECT_NEAR(estimated / truth, 1.0, 0.1);
}

TEST(ErrorEstimate, ItsIntervalIsAsWideAsTheErrorsSpread) {
    // Of a sum of squares of normal numbers with variances v: relative deviation sqrt(2 sum v^2) / sum v, and that of
    // the variances estimated from n samples on top; half of it for the root.
    double sum = 0, squares = 0;
    for (int p = 0; p < kSize * kSize; ++p) {
        const double v = std::pow(deviation(p % kSize, p / kSize), 2);
        sum += v;
        squares += v * v;
    }
    const double deviation = 0.5 * std::sqrt(2 * squares * (1 + 1.0 / 14)) / sum;
    // Somewhat wider, since thirty loud pixels make up most of the spread.
    const double width = try_hundred({16}, Noise::gaussian, Combination::fixed, false).relative_width;
    EXPECT_GT(width, 2 * 1.96 * deviation);
    EXPECT_LT(width, 1.3 * 2 * 1.96 * deviation);
}

/// An image of ones in which so many samples (of 16 a pixel) are much brighter, by amounts of their own.
PassResult rare_light(double events, unsigned seed) {
    std::mt19937 engine(seed);
    std::uniform_real_distribution<double> uniform;
    std::lognormal_distribution<double> light(0, 1);
    PassResult pass{16, 0, std::vector<PixelEstimate>(kSize * kSize)};
    for (PixelEstimate& pixel : pass.pixels)
        for (std::uint32_t s = 0; s < 16; ++s) {
            const bool event = uniform(engine) * 16 * kSize * kSize < events;
            pixel.add(s, Rgb(static_cast<float>(kMean + (event ? 30 * light(engine) : 0.0))));
        }
    return pass;
}

TEST(ErrorEstimate, IsHonestWhereFewSamplesAreTheWholeError) {
    for (const double events : {2.0, 30.0, 300.0, 3000.0}) {
        const double truth = kMean + 30 * std::exp(0.5) * events / (16 * kSize * kSize);
        int covered = 0, known = 0, narrow = 0;
        for (unsigned seed = 0; seed < 100; ++seed) {
            const std::vector<PassResult> passes = {rare_light(events, seed)};
            const CombinedImage image = combine_passes(passes, Combination::fixed, false);
            const ErrorEstimate error = estimate_error(image, seed);
            if (error.rmse == 0) continue;  // nothing rare was met
            double squares = 0;
            for (const Rgb64& m : image.mean)
                squares += (m.x - truth) * (m.x - truth) / (kSize * kSize);
            ++known;
            covered += error.low <= std::sqrt(squares) && std::sqrt(squares) <= error.high;
            narrow += error.high < 1.2 * error.low;
        }
        EXPECT_GE(covered, 0.9 * known) << events << " bright samples";
        if (events < 50) {
            EXPECT_EQ(narrow, 0) << "another such sample may come";
        }
    }
}

TEST(ErrorEstimate, OfAnImageWithoutNoiseIsZero) {
    PassResult pass{16, 0, std::vector<PixelEstimate>(9)};
    for (PixelEstimate& pixel : pass.pixels)
        for (std::uint32_t s = 0; s < 16; ++s)
            pixel.add(s, Rgb(2.0f));
    const ErrorEstimate error = estimate_error(combine_passes(std::vector{pass}, Combination::fixed, false), 1);
    EXPECT_TRUE(error.known);
    EXPECT_EQ(error.relative(), 0);
    EXPECT_EQ(error.relative_low(), 0);
    EXPECT_EQ(error.relative_high(), 0);
}

TEST(ErrorEstimate, IsTheSameForTheSameImage) {
    const CombinedImage image = combine_passes(synthetic_passes({8}, Noise::gaussian, 1), Combination::fixed, false);
    const ErrorEstimate a = estimate_error(image, 5), b = estimate_error(image, 5);
    EXPECT_EQ(a.low, b.low);
    EXPECT_EQ(a.high, b.high);
    EXPECT_NE(a.low, estimate_error(image, 6).low);
}

TEST(ErrorEstimate, KnowsWhatItDoesNotKnow) {
    const auto of = [](const std::vector<std::uint32_t>& spp) {
        return estimate_error(
            combine_passes(synthetic_passes(spp, Noise::gaussian, 1), Combination::inverse_variance, true), 0);
    };
    EXPECT_FALSE(of({1}).known);
    EXPECT_TRUE(of({1, 2}).known);
    EXPECT_FALSE(of({1, 2}).has_interval);
    EXPECT_GT(of({1, 2}).rmse, 0.0);
    EXPECT_TRUE(of({1, 2, 4}).has_interval);
}

TEST(ErrorEstimate, IsRelativeToTheMean) {
    ErrorEstimate error;
    error.rmse = 0.5;
    error.mean = 2.0;
    EXPECT_DOUBLE_EQ(error.relative(), 0.25);
    error.mean = 0;
    EXPECT_TRUE(std::isinf(error.relative()));
    error.rmse = 0;
    EXPECT_EQ(error.relative(), 0.0);
}

}  // namespace
}  // namespace treefarm
