// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/guiding/light_probabilities.h"
#include "common/guiding/mixture.h"
#include "common/guiding/refine.h"
#include "common/guiding/view_mixture.h"

namespace treefarm {

/// The way from what a pass recorded to the tree that guides the next one: refinement, and mixtures with what they
/// remember of earlier passes. Pure but for that memory.
class TreeLearner {
  public:
    /// `learn_mixture`: the pass recorded histograms.
    SdTree learn(const SdTree& tree, const TreeSums& sums, const RefineSettings& settings, bool learn_mixture,
                 RefineReport& report);

    /// Lists what it remembers, for a checkpoint.
    template <class Archive>
    void serialize(Archive& archive) {
        archive(lights_, mixture_, views_);
    }

  private:
    LightLearner lights_;
    MixtureLearner mixture_;
    ViewLearner views_;
};

}  // namespace treefarm
