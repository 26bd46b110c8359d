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
    float flux = 0.0f;  ///< of a region, if learned
};

/// Refines a distribution of the old tree by its records; cells that hit a limit are counted in the report.
RefinedDistribution refine_distribution(const SdTree& tree, const CellSums& sums, std::uint32_t distribution,
                                        const RefineSettings& settings, RefineReport& report);

/// Appends a distribution to a tree under construction.
void add_distribution(SdTree& tree, const RefinedDistribution& distribution, float bsdf_fraction);

/// Appends the views to a refined tree whose regions are complete. A T2 without records (or without benefit according
/// to `advice`) is released. One with more than RefineSettings::view_set_threshold records is cut where its regions are
/// cut, as often as a region would be; a view with more than view_threshold records splits into four, once. If there
/// would be more cells than RefineSettings::view_cells allows, those with the largest gain per cell are chosen.
void refine_views(const SdTree& tree, const CellSums& sums, const RefineSettings& settings,
                  std::span<const ViewAdvice> advice, SdTree& refined, RefineReport& report);

}  // namespace treefarm
