// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/guiding/regions/region_learner.h"
#include "common/guiding/sd_tree/refine.h"
#include "common/guiding/sd_tree/view_mixture.h"

namespace treefarm {

/// The way from what a pass recorded to the tree that guides the next one: refinement, and mixtures with what they
/// remember of earlier passes. Pure but for that memory.
class TreeLearner {
  public:
    /// `learn_mixture`: the pass recorded histograms.
    SdTree learn(const SdTree& tree, const CellSums& sums, const RefineSettings& settings, bool learn_mixture,
                 RefineReport& report);

    /// Lists what it remembers, for a checkpoint.
    template <class Archive>
    void serialize(Archive& archive) {
        archive(regions_, views_);
    }

  private:
    RegionLearner regions_;
    ViewLearner views_;
};

}  // namespace treefarm
