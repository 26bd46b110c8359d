// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/image/image.h"

namespace treefarm {

/// Two images and what is known about their errors. A variance is that of the pixel's mean, per channel; where there is
/// none, that image counts as exact.
struct ZTestInput {
    const RgbImage& image;
    const RgbImage& reference;
    const RgbImage* image_variance = nullptr;
    const RgbImage* reference_variance = nullptr;
    bool image_half = false;      ///< rounded to half: adds (v 2^-11)^2 / 3 to the variance of each value v
    bool reference_half = false;  ///< as image_half, for the reference
    /// Standard deviation of a relative error common to all pixels of the reference (another renderer's conventions,
    /// ...); more pixels do not average it away.
    double reference_relative_error = 0.0;
};

struct ZTestOptions {
    double significance = 0.01;      ///< chance of any false alarm among all tests, for the correction of Sidak
    double accepted_share = 0.9975;  ///< share of the pixel tests that must accept
    /// Least variance of a difference in the pixel test, in squared radiance: pixels whose rare bright paths were all
    /// missed estimate a variance near zero. Mitsuba 3 uses 1e-4 per sample, that is 1e-4 / spp.
    double variance_floor = 1e-8;
    /// The pixel test takes the larger of a pixel's variance and the mean over the window of this radius around it. A
    /// pixel whose few samples all missed the rare bright paths is too dark and thinks itself certain: the error of its
    /// own variance goes along with the error of its value, so the normal law holds only with a variance from outside.
    /// 0: off.
    int pool_radius = 2;
    int block = 16;  ///< side of a block in pixels, at least 1
};

/// Per pixel and channel: z = (a - b) / sqrt(variance of the difference), as Mitsuba 3's render tests do it.
struct PixelZTest {
    std::uint64_t tests = 0;
    std::uint64_t accepted = 0;
    std::uint64_t invalid = 0;  ///< pixels left out: a value or variance is NaN or infinite, or a variance negative
    double accepted_share = 1.0;
    double limit = 0.0;  ///< |z| that a test accepts, from the corrected level
    double max_abs_z = 0.0;
    double mean_z2 = 0.0;  ///< 1 if the variances are right; far below 1 if the floor rules
    bool pass = true;
};

/// Per block and channel: z of the block's mean difference. Finds a bias that hides below the noise of single pixels.
struct BlockZTest {
    std::uint64_t tests = 0;     ///< blocks with a valid pixel, times three channels
    std::uint64_t beyond_3 = 0;  ///< |z| > 3: 0.27 % of the tests by chance
    std::uint64_t beyond_4 = 0;  ///< |z| > 4: 0.0063 % by chance
    double mean_z2 = 0.0;        ///< chi-square per degree of freedom: near 1 without bias
    double max_abs_z = 0.0;
    int worst_x = 0, worst_y = 0;   ///< first pixel of the block that attains it
    double limit = 0.0;             ///< |z| that a test accepts, from the corrected level
    double image_z[3] = {0, 0, 0};  ///< z of the mean of the whole image, per channel
    bool pass = true;
};

/// The tests per pixel and per block. Both throw InputError if the sizes differ. Float rounding (relative 1e-6) counts
/// as noise, so no variance is zero.
PixelZTest pixel_z_test(const ZTestInput& input, const ZTestOptions& options = {});
BlockZTest block_z_test(const ZTestInput& input, const ZTestOptions& options = {});

}  // namespace treefarm
