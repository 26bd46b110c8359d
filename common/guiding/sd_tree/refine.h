// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "common/guiding/regions/refinement.h"
#include "common/guiding/sd_tree/sd_tree.h"
#include "common/guiding/statistics/cell_sums.h"

namespace treefarm {

/// Advice to refine() about a view, besides its sums.
struct ViewAdvice {
    double gain = 0;    ///< benefit of the view: views with more are kept and split first
    bool keep = false;  ///< a T2 is released if none of its views is to be kept
};

/// The next tree: spatial splits by record count, directional splits and prunings by energy, densities transferred to
/// the new topology (a split cell gives a quarter to each child, pruned cells are summed). Pure and deterministic.
/// Source: Mueller et al. 2017, section 3.3, with the thresholds of their program; views as in Cavus 2020, 2.5.5.2: all
/// parts of a split region share its T2, and a T2 without records is removed. `advice` is per view of `tree`; empty
/// keeps all.
SdTree refine(const SdTree& tree, const CellSums& sums, const RefineSettings& settings, RefineReport& report,
              std::span<const ViewAdvice> advice = {});

}  // namespace treefarm
