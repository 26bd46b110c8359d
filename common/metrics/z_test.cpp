// SPDX-License-Identifier: Apache-2.0
#include "common/metrics/z_test.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "common/metrics/error_metrics.h"
#include "common/metrics/normal_distribution.h"

namespace treefarm {

namespace {

using Rgb64 = Imath::Color3<double>;

/// Variance of rounding a value to half. The relative error is at most half a unit in the last place (absolute for
/// subnormals); it is uniform, so its variance is a third of the square of its maximum.
double half_rounding_variance(double value) {
    const double greatest = std::max(std::abs(value) * 0x1p-11, 0x1p-25);
    return greatest * greatest / 3.0;
}

/// Variance from rounding sums to float, so that it never counts as a bias.
double float_rounding_variance(double a, double b) {
    const double greatest = std::max(std::max(std::abs(a), std::abs(b)) * 1e-6, 1e-9);
    return greatest * greatest;
}

/// Difference of one pixel, the variance of that difference, and the reference value.
struct Difference {
    Rgb64 value, variance, reference;
};

bool is_variance(const Rgb& v) {
    return is_valid(v) && v.x >= 0.0f && v.y >= 0.0f && v.z >= 0.0f;
}

/// The difference of pixel i and its variance; false if the pixel is to be left out.
bool difference_at(const ZTestInput& in, std::size_t i, Difference& d) {
    const Rgb a = in.image.pixels[i], b = in.reference.pixels[i];
    const Rgb zero(0.0f);
    const Rgb va = in.image_variance != nullptr ? in.image_variance->pixels[i] : zero;
    const Rgb vb = in.reference_variance != nullptr ? in.reference_variance->pixels[i] : zero;
    if (!is_valid(a) || !is_valid(b) || !is_variance(va) || !is_variance(vb)) return false;
    for (int c = 0; c < 3; ++c) {
        const double x = a[c], y = b[c];
        d.value[c] = x - y;
        d.reference[c] = y;
        d.variance[c] = static_cast<double>(va[c]) + static_cast<double>(vb[c]) + float_rounding_variance(x, y) +
                        (in.image_half ? half_rounding_variance(x) : 0.0) +
                        (in.reference_half ? half_rounding_variance(y) : 0.0);
    }
    return true;
}

void require_sizes(const ZTestInput& in) {
    require_same_size(in.image, in.reference);
    if (in.image_variance != nullptr) require_same_size(*in.image_variance, in.reference);
    if (in.reference_variance != nullptr) require_same_size(in.image, *in.reference_variance);
}

double square(double v) {
    return v * v;
}

/// Mean variance of the valid pixels in the window around (x, y).
Rgb64 pooled_variance(const std::vector<std::optional<Difference>>& pixels, int width, int height, int x, int y,
                      int radius) {
    Rgb64 sum(0.0);
    int count = 0;
    for (int j = std::max(0, y - radius); j <= std::min(height - 1, y + radius); ++j)
        for (int i = std::max(0, x - radius); i <= std::min(width - 1, x + radius); ++i)
            if (const auto& d = pixels[static_cast<std::size_t>(j) * static_cast<std::size_t>(width) +
                                       static_cast<std::size_t>(i)]) {
                sum += d->variance;
                ++count;
            }
    return sum / static_cast<double>(std::max(count, 1));
}

/// Sums over the pixels of a block.
struct BlockSum {
    Rgb64 difference{0.0}, variance{0.0}, reference{0.0};
    std::uint64_t pixels = 0;

    void add(const Difference& d) {
        difference += d.value;
        variance += d.variance;
        reference += d.reference;
        ++pixels;
    }
    void add(const BlockSum& other) {
        difference += other.difference;
        variance += other.variance;
        reference += other.reference;
        pixels += other.pixels;
    }
    /// z of the mean; numerator and denominator both carry a factor of the number of pixels.
    double z(int c, double relative_error) const {
        return difference[c] / std::sqrt(variance[c] + square(relative_error * reference[c]));
    }
};

}  // namespace

PixelZTest pixel_z_test(const ZTestInput& input, const ZTestOptions& options) {
    require_sizes(input);
    PixelZTest result;
    const int width = input.image.width, height = input.image.height;
    std::vector<std::optional<Difference>> pixels(input.image.pixels.size());
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        Difference d;
        if (difference_at(input, i, d))
            pixels[i] = d;
        else
            ++result.invalid;
    }
    std::vector<double> z;
    z.reserve(pixels.size() * 3);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        if (!pixels[i]) continue;
        const Difference& d = *pixels[i];
        const int x = static_cast<int>(i) % width, y = static_cast<int>(i) / width;
        const Rgb64 pooled = pooled_variance(pixels, width, height, x, y, options.pool_radius);
        for (int c = 0; c < 3; ++c) {
            const double variance =
                std::max(d.variance[c], pooled[c]) + square(input.reference_relative_error * d.reference[c]);
            z.push_back(std::abs(d.value[c]) / std::sqrt(std::max(variance, options.variance_floor)));
        }
    }
    result.tests = z.size();
    // Sidak over pixels, not over pixels times channels: the channels of a pixel share their paths.
    result.limit = critical_z(sidak_level(options.significance, z.size() / 3));
    double sum = 0.0;
    for (const double value : z) {
        if (value <= result.limit) ++result.accepted;
        result.max_abs_z = std::max(result.max_abs_z, value);
        sum += value * value;
    }
    if (z.empty()) {
        result.pass = false;
        return result;
    }
    result.mean_z2 = sum / static_cast<double>(z.size());
    result.accepted_share = static_cast<double>(result.accepted) / static_cast<double>(z.size());
    result.pass = result.accepted_share >= options.accepted_share;
    return result;
}

BlockZTest block_z_test(const ZTestInput& input, const ZTestOptions& options) {
    require_sizes(input);
    const auto width = static_cast<std::size_t>(input.image.width),
               side = static_cast<std::size_t>(std::max(1, options.block));
    const std::size_t across = (width + side - 1) / side;
    const std::size_t down = (static_cast<std::size_t>(input.image.height) + side - 1) / side;
    std::vector<BlockSum> blocks(across * down);
    Difference d;
    for (std::size_t i = 0; i < input.image.pixels.size(); ++i)
        if (difference_at(input, i, d)) blocks[i / width / side * across + i % width / side].add(d);

    BlockZTest result;
    BlockSum whole;
    double sum = 0.0;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        if (blocks[i].pixels == 0) continue;
        whole.add(blocks[i]);
        for (int c = 0; c < 3; ++c) {
            const double z = std::abs(blocks[i].z(c, input.reference_relative_error));
            ++result.tests;
            result.beyond_3 += z > 3.0 ? 1 : 0;
            result.beyond_4 += z > 4.0 ? 1 : 0;
            sum += z * z;
            if (z <= result.max_abs_z) continue;
            result.max_abs_z = z;
            result.worst_x = static_cast<int>(i % across * side);
            result.worst_y = static_cast<int>(i / across * side);
        }
    }
    if (result.tests == 0) {
        result.pass = false;
        return result;
    }
    for (int c = 0; c < 3; ++c)
        result.image_z[c] = whole.z(c, input.reference_relative_error);
    result.mean_z2 = sum / static_cast<double>(result.tests);
    result.limit = critical_z(sidak_level(options.significance, result.tests));
    result.pass = result.max_abs_z <= result.limit;
    return result;
}

}  // namespace treefarm
