// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "common/guiding/regions/refinement.h"
#include "common/guiding/regions/region_model.h"
#include "common/guiding/statistics/cell_sums.h"

namespace treefarm {

/// The light share of an untaught region: next event chooses among all emitters, as where nothing is learned.
inline constexpr LightProbabilities kNothingLearned = {kLightProbabilityOne};

/// The coordinator's memory of what next event found in each region, from pass to pass (docs/design/guiding.md,
/// "Choosing emitters").
///
/// A sample of cluster c, chosen with the probability q, that brings X (f |cos| L over the density, weighed against
/// scattering) adds q X^2. The sum's expectation is what c contributes to the second moment if it is always chosen,
/// whatever q was, so sums of passes and workers add up. The choice that makes the variance least is proportional to
/// its root.
class LightLearner {
  public:
    /// Sets next.light_probabilities from what the pass over `tree` recorded. `origins` as in MixtureLearner.
    void learn(const RegionModel& tree, const CellSums& sums, std::span<const RegionOrigin> origins, RegionModel& next);

    /// Lists what it remembers, for a checkpoint.
    template <class Archive>
    void serialize(Archive& archive) {
        archive(evidence_);
    }

  private:
    struct Evidence {
        std::array<double, kLightClusters> moments{};  ///< in radiance squared, not in quanta
        double vertices = 0;                           ///< that were recorded

        template <class Archive>
        void serialize(Archive& archive) {
            archive(moments, vertices);
        }
    };
    std::vector<Evidence> evidence_;  ///< per region of the coming tree
};

/// The share of a region that recorded `vertices` with these second moments, if its parent's share is `prior`.
LightProbabilities learned_probabilities(std::span<const double, kLightClusters> moments, double vertices,
                                         const LightProbabilities& prior);

}  // namespace treefarm
