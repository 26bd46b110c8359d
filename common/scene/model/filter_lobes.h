// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "common/scene/model/scene.h"

namespace treefarm {

/// Filters with negative lobes, along one axis; the film's filter is the product over both axes.

/// Value of the filter at a distance of `x` pixels, for a film that is_signed().
double lobe_value(const Film& film, double x);

/// Integrals of a function over equal bins of [0, radius], by Simpson's rule.
std::vector<double> bin_masses(const std::function<double(double)>& value, double radius, std::uint32_t bins);

/// Integrals of the film's filter over equal bins of [0, radius].
std::vector<double> lobe_masses(const Film& film, std::uint32_t bins);

/// Ratio of the sum of absolute masses to their sum: the weight of a sample, of either sign.
double excess_of(const std::vector<double>& masses);

/// Factor by which squares of samples grow because negative lobes are subtracted: (integral of |f|)^2 / (integral of
/// f)^2 over the film's plane. 1 for a filter without negative lobes.
double sign_cost(const Film& film);

}  // namespace treefarm
