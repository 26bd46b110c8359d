// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/image/image.h"

namespace treefarm {

/// Two images and their errors. A variance is that of a pixel's mean, per channel; an image without variances counts as
/// exact.
struct ZTestInput {
    const RgbImage& image;
    const RgbImage& reference;
    const RgbImage* image_variance = nullptr;
    const RgbImage* reference_variance = nullptr;
    bool image_half = false;      ///< values were rounded to half: adds (v 2^-11)^2 / 3 to the variance of each value v
    bool reference_half = false;  ///< as image_half, for the reference
    /// Standard deviation of a relative error common to all pixels of the reference (such as another renderer's
    /// conventions); averaging over pixels does not reduce it.
    double reference_relative_error = 0.0;
};

struct ZTestOptions {
    double significance = 0.01;      ///< chance of any false alarm among all tests, for Sidak's correction
    double accepted_share = 0.9975;  ///< least share of pixel tests that must accept
    /// Least variance of a difference in the pixel test, in squared radiance. If a pixel has missed all of its rare
    /// bright paths, its estimated variance is near zero. Mitsuba 3 uses 1e-4 per sample, that is 1e-4 / spp.
    double variance_floor = 1e-8;
    /// Radius in pixels of a window: the pixel test uses the larger of a pixel's own variance and the window's mean. A
    /// pixel that missed its rare bright paths is too dark and also underestimates its variance; the two errors are
    /// correlated, so the normal law holds only with a variance from other pixels. 0: off.
    int pool_radius = 2;
    int block = 16;  ///< side of a block in pixels, at least 1
};

/// Test per pixel and channel: z = (a - b) / sqrt(variance of the difference), as in Mitsuba 3's render tests.
struct PixelZTest {
    std::uint64_t tests = 0;
    std::uint64_t accepted = 0;
    std::uint64_t invalid = 0;  ///< pixels left out: NaN or infinite value or variance, or negative variance
    double accepted_share = 1.0;
    double limit = 0.0;  ///< greatest |z| that a test accepts, by the corrected level
    double max_abs_z = 0.0;
    double mean_z2 = 0.0;  ///< mean of z^2: 1 if the variances are right; far below 1 if the floor dominates
    bool pass = true;
};

/// Test per block and channel: z of the block's mean difference. Finds a bias below the noise of single pixels.
struct BlockZTest {
    std::uint64_t tests = 0;     ///< blocks with a valid pixel, times three channels
    std::uint64_t beyond_3 = 0;  ///< tests with |z| > 3; 0.27 % by chance
    std::uint64_t beyond_4 = 0;  ///< tests with |z| > 4; 0.0063 % by chance
    double mean_z2 = 0.0;        ///< mean of z^2, near 1 without bias
    double max_abs_z = 0.0;
    int worst_x = 0, worst_y = 0;   ///< first pixel of the block with the greatest |z|
    double limit = 0.0;             ///< greatest |z| that a test accepts, by the corrected level
    double image_z[3] = {0, 0, 0};  ///< z of the mean of the whole image, per channel
    bool pass = true;
};

/// The tests per pixel and per block. Both throw InputError if the sizes differ. Float rounding (relative 1e-6) counts
/// as noise, so no variance is zero.
PixelZTest pixel_z_test(const ZTestInput& input, const ZTestOptions& options = {});
BlockZTest block_z_test(const ZTestInput& input, const ZTestOptions& options = {});

}  // namespace treefarm
