// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "common/film/pixel_estimate.h"

namespace treefarm {

/// Smallest share of the pixels that carries `part`, in (0, 1], of the sum of all variances (luminance); empty if the
/// sum is zero.
std::optional<double> noise_share(std::span<const Rgb64> variance, double part);

}  // namespace treefarm
