// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/film/pixel_estimate.h"
#include "common/film/splat_film.h"

namespace treefarm {

/// Samples of each half: even and odd numbers.
using HalfCounts = std::array<std::uint32_t, 2>;

/// Even and odd numbers among [first, first + count).
HalfCounts half_counts(std::uint64_t first, std::uint32_t count);

/// The image of a pass from its layers, in the one form that combination, error and budgets know: pixel estimates to
/// which the splats' means and variances are added. `paths`: per pixel that splatted, by halves. Where a pass has no
/// estimates (none are given) it is the number of samples as well; where it has, a half counts only if both layers have
/// something of it. Whoever divides a sample variance by n gets the variance of the mean (docs/design/error.md,
/// "splats"). Without splats, `estimates` as they are. `chains`: Markov chains of each half, where they splatted; a
/// half with less than two has no variance and does not count.
std::vector<PixelEstimate> develop(std::vector<PixelEstimate> estimates, const SplatSums& splats,
                                   const HalfCounts& paths, const HalfCounts& chains = {});

}  // namespace treefarm
