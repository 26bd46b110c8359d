// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/math/vec.h"

namespace treefarm {

using Rgb64 = Imath::Color3<double>;

/// Running mean and sum of squared deviations per channel, in double (Welford 1962; merging: Chan et al. 1979).
struct Moments {
    std::uint32_t n = 0;
    Rgb64 mean{0.0};
    Rgb64 m2{0.0};

    void add(const Rgb& value);
    /// Moments of the union of two sets of samples. Not associative in the last bit: merge along a fixed tree.
    static Moments merge(const Moments& a, const Moments& b);
    /// Unbiased variance of one sample; 0 for fewer than two.
    Rgb64 sample_variance() const { return n < 2 ? Rgb64(0.0) : m2 / static_cast<double>(n - 1); }
};

/// Samples of a pixel in two independent halves, even and odd ones (docs/design/error.md, "combining passes").
struct PixelEstimate {
    Moments half[2];

    void add(std::uint32_t sample, const Rgb& value) { half[sample & 1].add(value); }
    static PixelEstimate merge(const PixelEstimate& a, const PixelEstimate& b);
    /// Moments of all samples.
    Moments whole() const { return Moments::merge(half[0], half[1]); }
};

}  // namespace treefarm
