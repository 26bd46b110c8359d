// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/film/pixel_estimate.h"
#include "common/film/splat_film.h"

namespace treefarm {

/// Number of samples of each half: even and odd indices.
using HalfCounts = std::array<std::uint32_t, 2>;

/// Number of even and of odd indices in [first, first + count).
HalfCounts half_counts(std::uint64_t first, std::uint32_t count);

/// Image of a pass from its layers: pixel estimates with the means and variances of splats added, the form that
/// combination, error estimate and budgets use. A sample variance divided by n is the variance of the mean
/// (docs/design/error.md, "splats"). `paths`: paths per pixel that splatted, by halves. For a pass without estimates
/// (an empty vector) it is the number of samples, too; otherwise a half counts only if both layers have samples of it.
/// `chains`: Markov chains of each half if they splatted; a half with fewer than two has no variance and does not
/// count. Without splats, `estimates` is returned as it is.
std::vector<PixelEstimate> develop(std::vector<PixelEstimate> estimates, const SplatSums& splats,
                                   const HalfCounts& paths, const HalfCounts& chains = {});

}  // namespace treefarm
