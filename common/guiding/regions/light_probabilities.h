// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "common/guiding/regions/refinement.h"
#include "common/guiding/regions/region_model.h"
#include "common/guiding/statistics/cell_sums.h"

namespace treefarm {

/// Probabilities of a region that has learned nothing: next event chooses among all emitters.
inline constexpr LightProbabilities kNothingLearned = {kLightProbabilityOne};

/// Learner of the emitter choice per region, from the contributions of next event (docs/design/guiding.md, "Choosing
/// emitters").
///
/// A sample of cluster c, chosen with probability q, with contribution X (f |cos| L over the density, weighted against
/// scattering) adds q X^2. The expectation of the sum is the second moment of c when it is always chosen, independent
/// of q, so sums of passes and workers add up. Variance is least if c is chosen in proportion to the root of its sum.
class LightLearner {
  public:
    /// Sets next.light_probabilities from the records of the pass over `tree`. `origins` as in MixtureLearner.
    void learn(const RegionModel& tree, const CellSums& sums, std::span<const RegionOrigin> origins, RegionModel& next);

    /// Archives the state, for a checkpoint.
    template <class Archive>
    void serialize(Archive& archive) {
        archive(evidence_);
    }

  private:
    struct Evidence {
        std::array<double, kLightClusters> moments{};  ///< second moments in radiance squared, not in quanta
        double vertices = 0;                           ///< number of recorded vertices

        template <class Archive>
        void serialize(Archive& archive) {
            archive(moments, vertices);
        }
    };
    std::vector<Evidence> evidence_;  ///< per region of the next tree
};

/// Probabilities of a region that recorded `vertices` with these second moments; `prior`: those of its parent.
LightProbabilities learned_probabilities(std::span<const double, kLightClusters> moments, double vertices,
                                         const LightProbabilities& prior);

}  // namespace treefarm
