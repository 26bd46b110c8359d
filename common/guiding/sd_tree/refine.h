// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "common/guiding/regions/refinement.h"
#include "common/guiding/sd_tree/sd_tree.h"
#include "common/guiding/statistics/cell_sums.h"

namespace treefarm {

/// Advice for refine() about a view, besides its sums.
struct ViewAdvice {
    double gain = 0;    ///< what it is good for: the more, the sooner it is kept and split
    bool keep = false;  ///< a T2 of which no view is worth keeping is released
};

/// The next tree: spatial splits by record count, directional splits and prunings by energy, densities re-expressed on
/// the new topology (a split cell gives a quarter to each child, pruned cells are summed). Pure and deterministic.
/// Source: Mueller et al. 2017, section 3.3, with the thresholds as their program has them; views as in Cavus 2020,
/// 2.5.5.2: a T2 goes to all parts of a split region, and away where nothing was recorded. `advice` per view of `tree`;
/// without it all are kept.
SdTree refine(const SdTree& tree, const CellSums& sums, const RefineSettings& settings, RefineReport& report,
              std::span<const ViewAdvice> advice = {});

}  // namespace treefarm
