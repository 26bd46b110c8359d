// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "common/image/image.h"
#include "common/metrics/z_test.h"
#include "tests/support/local_render.h"

namespace treefarm::test {

/// An image with its variance, in the form of the z-tests.
struct Rendered {
    RgbImage mean, variance;
};

inline Rendered rendered(const LocalRender& run, const Film& film) {
    Rendered images;
    images.mean = images.variance = RgbImage(film.width, film.height);
    for (std::size_t p = 0; p < images.mean.pixels.size(); ++p) {
        images.mean.pixels[p] = Rgb(run.image.mean[p]);
        images.variance.pixels[p] = Rgb(run.image.variance[p]);
    }
    return images;
}

/// Holds two images against each other by all z-tests, in blocks of 8 x 8 pixels.
inline void expect_z_tests_pass(const ZTestInput& input) {
    ZTestOptions options;
    options.block = 8;
    const BlockZTest blocks = block_z_test(input, options);
    const PixelZTest pixels = pixel_z_test(input, options);
    EXPECT_TRUE(blocks.pass) << "worst block z " << blocks.max_abs_z << " of " << blocks.limit;
    EXPECT_LT(blocks.mean_z2, 2.0);
    EXPECT_TRUE(pixels.pass) << pixels.accepted << " of " << pixels.tests;
    for (const double z : blocks.image_z)
        EXPECT_LT(std::abs(z), 4.0);
}

/// Compares an image with path tracing's within both uncertainties, in blocks and as a whole. `noise`: largest allowed
/// noise of its mean.
inline void expect_same_image(const Rendered& image, const Rendered& path, const std::string& what,
                              double noise = 0.02) {
    ZTestOptions options;
    options.block = 8;
    const BlockZTest blocks = block_z_test({image.mean, path.mean, &image.variance, &path.variance}, options);
    EXPECT_TRUE(blocks.pass) << what << ": worst block z " << blocks.max_abs_z << " of " << blocks.limit;
    EXPECT_LT(blocks.mean_z2, 3.0) << what;  // of nine blocks or more, whose channels are correlated
    for (const double z : blocks.image_z)
        EXPECT_LT(std::abs(z), 4.0) << what;
    double sum = 0, variance = 0;
    for (std::size_t p = 0; p < image.mean.pixels.size(); ++p) {
        sum += double(average(image.mean.pixels[p]));
        variance += double(average(image.variance.pixels[p]));
    }
    EXPECT_GT(sum, 0.0) << what << ": black";
    EXPECT_LT(std::sqrt(variance), noise * sum) << what << ": too noisy to tell";
}

}  // namespace treefarm::test
