// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "report/html.h"
#include "report/statistics.h"

namespace treefarm {
namespace {

TEST(Report, IntervalsAreStudents) {
    // Logarithms 0, 1, 2: mean 1, deviation 1, t = 4.302652729749461 with two degrees of freedom.
    const std::vector<double> values = {1, std::exp(1.0), std::exp(2.0)};
    const Interval interval = geometric_mean(values);
    EXPECT_NEAR(interval.mean, std::exp(1.0), 1e-12);
    EXPECT_NEAR(interval.low, std::exp(1 - 4.302652729749461 / std::sqrt(3.0)), 1e-12);
    EXPECT_NEAR(interval.high, std::exp(1 + 4.302652729749461 / std::sqrt(3.0)), 1e-12);
    EXPECT_TRUE(std::isnan(geometric_mean(std::vector<double>{2}).low)) << "one value has no interval";
    EXPECT_TRUE(std::isnan(geometric_mean({}).mean));
    std::vector<double> many(31, 1.0);
    many.front() = std::exp(1.0);  // t = 2.042 with thirty degrees of freedom
    const double deviation = std::sqrt((1 - 1.0 / 31) / 30);
    EXPECT_NEAR(std::log(geometric_mean(many).high), 1.0 / 31 + 2.042 * deviation / std::sqrt(31.0), 2e-4);
}

TEST(Report, RatiosAreOfPairs) {
    const std::vector<double> a = {2, 20, 200}, b = {1, 10, 100};
    const Interval ratio = geometric_ratio(a, b);
    EXPECT_NEAR(ratio.mean, 2, 1e-12);
    EXPECT_NEAR(ratio.low, 2, 1e-9) << "seeds that differ by themselves do not widen it";
}

TEST(Report, TimesAreReadOffTheCurve) {
    const std::vector<CurvePoint> curve = {{1, 0.4}, {4, 0.2}, {16, 0.1}};
    EXPECT_NEAR(time_to(curve, 0.2).seconds, 4, 1e-12);
    EXPECT_NEAR(time_to(curve, 0.1 * std::sqrt(2.0)).seconds, 8, 1e-12);
    EXPECT_FALSE(time_to(curve, 0.1).extrapolated);
    EXPECT_NEAR(time_to(curve, 0.05).seconds, 64, 1e-9);
    EXPECT_TRUE(time_to(curve, 0.05).extrapolated);
    EXPECT_EQ(time_to(curve, 0.9).seconds, 1) << "no image is there before its first pass";
    EXPECT_TRUE(std::isnan(time_to({}, 0.1).seconds));
    EXPECT_NEAR(error_at(curve, 2), 0.2 * std::sqrt(2.0), 1e-12);
    EXPECT_NEAR(error_at(curve, 16), 0.1, 1e-12);
    EXPECT_NEAR(error_at(curve, 1), 0.4, 1e-12);
}

TEST(Report, ErrorsThatRiseAgainAreReachedOnce) {
    const std::vector<CurvePoint> curve = {{1, 0.4}, {2, 0.1}, {4, 0.3}, {8, 0.2}};
    EXPECT_NEAR(time_to(curve, 0.1).seconds, 2, 1e-12);
}

TEST(Report, ImagesTravelWithACommonExponent) {
    RgbImage image(1, 2);
    image.pixels = {Rgb(1.0f, 0.5f, 0.0f), Rgb(-1.0f, NAN, 0.0f)};
    // 1 = 128 x 2^-7: mantissas 128, 64, 0, exponent 129; black is zeros.
    EXPECT_EQ(base64_rgbe(image), "gEAAgQAAAAA=");
}

TEST(Report, TextIsNoMarkup) {
    EXPECT_EQ(html_text("<a href=\"x\">&"), "&lt;a href=&quot;x&quot;&gt;&amp;");
}

}  // namespace
}  // namespace treefarm
