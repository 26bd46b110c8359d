// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "common/base/error.h"
#include "common/metrics/difference.h"
#include "common/metrics/error_metrics.h"
#include "tests/support/small_image.h"

namespace treefarm {
namespace {

using test::image_of;
using test::kInf;
using test::kNan;

TEST(ErrorMetrics, AgreesWithHandComputedValues) {
    const RgbImage a = image_of(2, 1, {Rgb(1.0f, 0.5f, 0.0f), Rgb(2.0f, 2.0f, 2.0f)});
    const RgbImage b = image_of(2, 1, {Rgb(0.5f, 0.5f, 0.0f), Rgb(1.0f, 2.0f, 4.0f)});
    const ErrorMetrics m = measure_error(a, b);
    EXPECT_EQ(m.compared, 2u);
    EXPECT_NEAR(m.mse, (0.25 + 1.0 + 4.0) / 6.0, 1e-12);
    EXPECT_NEAR(m.rmse, std::sqrt(5.25 / 6.0), 1e-12);
    EXPECT_NEAR(m.rel_mse, (0.25 / 0.26 + 1.0 / 1.01 + 4.0 / 16.01) / 6.0, 1e-12);
    EXPECT_NEAR(m.mape, (0.5 / 0.51 + 1.0 / 1.01 + 2.0 / 4.01) / 6.0, 1e-12);
    EXPECT_NEAR(m.smape, 2.0 * (0.5 / 1.51 + 1.0 / 3.01 + 2.0 / 6.01) / 6.0, 1e-12);
    const double mean_a = (0.212671 * 3.0 + 0.715160 * 2.5 + 0.072169 * 2.0) / 2.0;
    const double mean_b = (0.212671 * 1.5 + 0.715160 * 2.5 + 0.072169 * 4.0) / 2.0;
    EXPECT_NEAR(m.mean_image, mean_a, 1e-12);
    EXPECT_NEAR(m.mean_ratio, mean_a / mean_b, 1e-12);
    EXPECT_NEAR(m.channel_ratio[0], 2.0, 1e-12);
    EXPECT_NEAR(m.channel_ratio[2], 0.5, 1e-12);
    EXPECT_EQ(m.trimmed, 0u);
    EXPECT_EQ(m.rel_mse_trimmed, m.rel_mse);
}

TEST(ErrorMetrics, TrimmingDropsExactlyTheWorstPixels) {
    const RgbImage b(50, 40, Rgb(1.0f));
    RgbImage a(50, 40, Rgb(1.1f));
    a.pixels[7] = Rgb(1000.0f);
    a.pixels[1999] = Rgb(500.0f);
    const ErrorMetrics m = measure_error(a, b);
    EXPECT_EQ(m.trimmed, 2u);
    EXPECT_NEAR(m.rel_mse_trimmed, 0.01 / 1.01, 1e-7);
    EXPECT_NEAR(m.mean_ratio_trimmed, 1.1, 1e-6);
    EXPECT_GT(m.rel_mse, 100.0);
    EXPECT_NEAR(m.block_ratio_median, 1.1, 1e-6);
}

TEST(ErrorMetrics, OutliersAreFarBeyondWhatIsUsual) {
    const RgbImage b(50, 40, Rgb(1.0f));
    RgbImage a(50, 40, Rgb(1.1f));
    a.pixels[7] = Rgb(1.99f);    // 0.97: less than its own value
    a.pixels[57] = Rgb(2.5f);    // 2.2
    a.pixels[1999] = Rgb(5.0f);  // 15.8
    ErrorMetrics m = measure_error(a, b);
    EXPECT_EQ(m.outliers, 2u);
    EXPECT_EQ(m.outlier_limit, 1.0);
    EXPECT_NEAR(m.worst, 16.0 / 1.01, 1e-9);
    EXPECT_EQ(m.worst_x, 49);
    EXPECT_EQ(m.worst_y, 39);
    for (Rgb& c : a.pixels)
        if (c.x < 1.2f) c = Rgb(1.2f);
    m = measure_error(a, b);
    EXPECT_NEAR(m.outlier_limit, 100.0 * 0.04 / 1.01, 1e-4) << "100 times the median";
    EXPECT_EQ(m.outliers, 1u);
}

TEST(ErrorMetrics, CountsPixelsBelowZeroAndComparesThem) {
    RgbImage a(4, 1, Rgb(1.0f)), b(4, 1, Rgb(1.0f));
    a.pixels[0] = Rgb(1.0f, -1.0f, 1.0f);
    a.pixels[1] = Rgb(-1.0f, -1.0f, kNan);
    b.pixels[2] = b.pixels[3] = Rgb(1.0f, 1.0f, -2.0f);
    const ErrorMetrics m = measure_error(a, b);
    EXPECT_EQ(m.negative_image, 1u);
    EXPECT_EQ(m.negative_reference, 2u);
    EXPECT_NEAR(m.mse, (4.0 + 9.0 + 9.0) / 9.0, 1e-12);
}

TEST(ErrorMetrics, CountsInvalidPixelsAndLeavesThemOut) {
    RgbImage a(10, 10, Rgb(1.0f)), b(10, 10, Rgb(1.0f));
    a.pixels[0] = Rgb(kNan, 1.0f, 1.0f);
    a.pixels[1] = Rgb(1.0f, kInf, 1.0f);
    a.pixels[2] = Rgb(1.0f, 1.0f, -kInf);
    b.pixels[2] = Rgb(kNan);
    b.pixels[3] = Rgb(1.0f, 1.0f, kNan);
    const ErrorMetrics m = measure_error(a, b);
    EXPECT_EQ(m.pixels, 100u);
    EXPECT_EQ(m.invalid_image, 3u);
    EXPECT_EQ(m.invalid_reference, 2u);
    EXPECT_EQ(m.compared, 96u);
    EXPECT_EQ(m.mse, 0.0);
    EXPECT_EQ(m.mean_ratio, 1.0);
}

TEST(ErrorMetrics, BlackAndInvalidReferencesDivideByNothing) {
    const RgbImage black(4, 4), grey(4, 4, Rgb(0.5f));
    const ErrorMetrics both = measure_error(black, black);
    EXPECT_EQ(both.rel_mse, 0.0);
    EXPECT_EQ(both.mape, 0.0);
    EXPECT_TRUE(std::isnan(both.mean_ratio));
    const ErrorMetrics m = measure_error(grey, black);
    EXPECT_NEAR(m.rel_mse, 25.0, 1e-9);
    EXPECT_TRUE(std::isnan(m.mean_ratio));
    EXPECT_TRUE(std::isnan(m.block_ratio_median));
    const ErrorMetrics none = measure_error(grey, RgbImage(4, 4, Rgb(kNan)));
    EXPECT_EQ(none.compared, 0u);
    EXPECT_TRUE(std::isnan(none.mse));
}

TEST(ErrorMetrics, RefusesDifferentSizes) {
    EXPECT_THROW(measure_error(RgbImage(2, 3), RgbImage(3, 2)), InputError);
    EXPECT_THROW(measure_error(RgbImage(), RgbImage()), InputError);
    EXPECT_THROW(difference_image(RgbImage(2, 3), RgbImage(3, 2)), InputError);
}

TEST(Difference, IsBlueWhiteRed) {
    const RgbImage b(5, 1, Rgb(0.99f));
    const RgbImage a = image_of(5, 1, {Rgb(0.99f), Rgb(9.0f), Rgb(0.0f), Rgb(0.99f + 0.25f), Rgb(kNan)});
    const RgbImage d = difference_image(a, b, 0.5);
    EXPECT_EQ(d.pixels[0], Rgb(1.0f));
    EXPECT_EQ(d.pixels[1], Rgb(1.0f, 0.0f, 0.0f));
    EXPECT_EQ(d.pixels[2], Rgb(0.0f, 0.0f, 1.0f));
    EXPECT_NEAR(d.pixels[3].y, 0.5f, 1e-5f);
    EXPECT_EQ(d.pixels[4], Rgb(1.0f, 0.0f, 1.0f));
}

}  // namespace
}  // namespace treefarm
