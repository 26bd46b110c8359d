// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "common/scene/model/scene.h"

namespace treefarm {

/// Filters with negative lobes, along one axis (the film's filter is the product of both).

/// The filter's value at a distance of `x` pixels: of a film that is_signed().
double lobe_value(const Film& film, double x);

/// Integrals of a function over equal bins of [0, radius], by Simpson's rule.
std::vector<double> bin_masses(const std::function<double(double)>& value, double radius, std::uint32_t bins);

/// Integrals of the film's filter over equal bins of [0, radius].
std::vector<double> lobe_masses(const Film& film, std::uint32_t bins);

/// By how much the absolute values of the masses exceed their sum: what a sample of either sign weighs.
double excess_of(const std::vector<double>& masses);

/// By how much the squares of samples grow, since those in negative lobes are taken away again: (integral of |f|)^2 /
/// (integral of f)^2 over the film's plane. 1 for a filter without negative lobes.
double sign_cost(const Film& film);

}  // namespace treefarm
