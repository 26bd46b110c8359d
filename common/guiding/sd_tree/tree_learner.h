// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/guiding/regions/region_learner.h"
#include "common/guiding/sd_tree/refine.h"
#include "common/guiding/sd_tree/view_mixture.h"

namespace treefarm {

/// Learner of the SD-tree: turns the records of a pass into the tree that guides the next, by refinement and by
/// learning mixtures. Pure, except for its memory of earlier passes.
class TreeLearner {
  public:
    /// `learn_mixture`: the pass recorded mixture histograms.
    SdTree learn(const SdTree& tree, const CellSums& sums, const RefineSettings& settings, bool learn_mixture,
                 RefineReport& report);

    /// Archives the state, for a checkpoint.
    template <class Archive>
    void serialize(Archive& archive) {
        archive(regions_, views_);
    }

  private:
    RegionLearner regions_;
    ViewLearner views_;
};

}  // namespace treefarm
