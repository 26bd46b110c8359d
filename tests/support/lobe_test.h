// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "common/math/vec.h"

namespace treefarm::test {

struct LobeTest {
    double p_value = 0;
    double integral = 0;  ///< of the density over the cells
    double inside = 0;    ///< fraction of the samples in them
};

/// Compares a sampler with its density, most of which is within about the widths of `center`: a chi-square test in
/// cells of the plane through `center`, whose coordinates (horizontal and perpendicular to it) are compressed as x /
/// (|x| + width), or, for a narrow lobe on top of a wide one, as the logarithm of 1 + |x| / width, up to |x| = 30.
/// Samples that fail, or are outside the cells or the hemisphere about the centre, are one more cell. For a lobe at the
/// horizon, choose a centre with z = 0. `sample(i, direction)` returns false for "none".
LobeTest test_lobe(const std::function<bool(std::uint32_t, Vec3&)>& sample,
                   const std::function<double(const Vec3&)>& density, const Vec3& center, double across_width,
                   double along_width, std::uint32_t samples, int resolution = 12, int sub = 24,
                   bool logarithmic = false);

}  // namespace treefarm::test
