// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "common/math/vec.h"

namespace treefarm::test {

/// Probability that a chi-square variable with `freedom` degrees exceeds `statistic`.
double chi_square_p_value(double statistic, double freedom);

/// Probability that a standard normal variable exceeds |z| in absolute value.
double normal_p_value(double z);

/// Pearson's test of counts against expected counts. Cells are pooled, smallest expectation first, until each has at
/// least 5. A count in a cell of expectation 0 gives p = 0.
double chi_square_test(const std::vector<double>& counts, const std::vector<double>& expected);

/// Result of comparing a direction sampler with its density.
struct DirectionTest {
    double p_value = 0;
    double integral = 0;  ///< of the density over the sphere; should equal the success rate
    double success = 0;   ///< fraction of the samples that were accepted
};

/// Draws `samples` directions (`sample(i, direction)` returns false for "none") and compares their counts in equal
/// cells of the octahedral map, `resolution` by `resolution`, with the density, integrated by midpoints over `sub` x
/// `sub` points of each cell.
DirectionTest test_directions(const std::function<bool(std::uint32_t, Vec3&)>& sample,
                              const std::function<double(const Vec3&)>& density, std::uint32_t samples,
                              int resolution = 16, int sub = 24);

}  // namespace treefarm::test
