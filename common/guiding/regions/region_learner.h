// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/guiding/regions/light_probabilities.h"
#include "common/guiding/regions/mixture.h"
#include "common/guiding/regions/next_event.h"

namespace treefarm {

/// Common part of all learners: emitter choice, next event and mixtures, by region.
class RegionLearner {
  public:
    /// Sets the three in `next` from the sums of a pass over `model`. `learn_mixture`: the pass recorded mixture
    /// histograms. `report` provides the origins of the regions and receives the verdict on next event.
    void learn(const RegionModel& model, const CellSums& sums, const RefineSettings& settings, bool learn_mixture,
               RefineReport& report, RegionModel& next) {
        if (model.learns_lights()) lights_.learn(model, sums, report.origins, next);
        if (model.decides_next_event()) next_event_.learn(model, sums, settings, report, next);
        if (learn_mixture) mixture_.learn(model, sums, report.origins, next);
    }

    /// Archives the state, for a checkpoint.
    template <class Archive>
    void serialize(Archive& archive) {
        archive(lights_, next_event_, mixture_);
    }

  private:
    LightLearner lights_;
    NextEventLearner next_event_;
    MixtureLearner mixture_;
};

}  // namespace treefarm
