// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "common/guiding/sd_tree/refine.h"
#include "common/guiding/sd_tree/refine_directions.h"

namespace treefarm {

/// A distribution on its refined topology.
struct RefinedDistribution {
    RefinedDirections directions;
    std::int16_t quantum_exponent;
    float flux = 0.0f;  ///< of a region, where that is learned
};

/// A distribution of the old tree by what was recorded in it; what was capped is added to the report.
RefinedDistribution refine_distribution(const SdTree& tree, const CellSums& sums, std::uint32_t distribution,
                                        const RefineSettings& settings, RefineReport& report);

/// Appends a distribution to a tree that is being built.
void add_distribution(SdTree& tree, const RefinedDistribution& distribution, float bsdf_fraction);

/// Appends the views to a refined tree whose regions are complete. A T2 without records (or that `advice` thinks
/// nothing of) is released. One with more than RefineSettings::view_set_threshold records is cut where its regions are
/// cut, as often as a region would be; a view with more than view_threshold splits into four, once. Where there would
/// be more cells than RefineSettings::view_cells allows, what has the largest gain for its cells is chosen.
void refine_views(const SdTree& tree, const CellSums& sums, const RefineSettings& settings,
                  std::span<const ViewAdvice> advice, SdTree& refined, RefineReport& report);

}  // namespace treefarm
