// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

#include "common/film/pixel_estimate.h"

namespace treefarm {

/// Limit of a sample's radiance and of an AOV: far below the largest float, so that means fit a float, and sums of
/// squares and their squares fit a double. A sample above it counts as invalid.
inline constexpr float kMostRadiance = 1e32f;

/// Whether a sum of `samples` numbers within kMostRadiance, of either sign, may have this value; the margin is for
/// rounding and for weights of filters with negative lobes.
inline bool is_sum_of(std::uint64_t samples, double value) {
    return std::abs(value) <= 16.0 * kMostRadiance * static_cast<double>(samples);
}

/// Whether samples within kMostRadiance may have these moments; `is_signed`: negative means are possible.
inline bool are_moments_of_radiance(const Moments& moments, bool is_signed) {
    constexpr double kMostSquare = 256.0 * kMostRadiance * kMostRadiance;
    for (int c = 0; c < 3; ++c) {
        if (!is_sum_of(1, moments.mean[c]) || (moments.mean[c] < 0 && !is_signed)) return false;
        if (!(moments.m2[c] >= 0 && moments.m2[c] <= kMostSquare * moments.n)) return false;
    }
    return true;
}

}  // namespace treefarm
