// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/decide/next_event/next_event_choice.h"
#include "common/guiding/regions/refinement.h"
#include "common/guiding/regions/region_model.h"
#include "common/guiding/statistics/cell_sums.h"

namespace treefarm {

/// Evidence per region of a tree, in which regions with few vertices use the means of the enclosing cubes. The entry
/// for the spread becomes the variance of the known difference of the last moment and the first.
std::vector<NextEventEvidence> pool_next_event(const RegionModel& tree, std::span<const NextEventEvidence> evidence);

/// Learner of the number of light samples per region.
class NextEventLearner {
  public:
    /// Sets next.next_event from the sums of the pass over `tree`. `report` provides the origins of the regions and
    /// receives the verdict.
    void learn(const RegionModel& tree, const CellSums& sums, const RefineSettings& settings, RefineReport& report,
               RegionModel& next);

    /// Archives the state, for a checkpoint.
    template <class Archive>
    void serialize(Archive& archive) {
        archive(evidence_, paths_);
    }

  private:
    std::vector<NextEventEvidence> evidence_;  ///< per region of the next tree
    double paths_ = 0;                         ///< camera samples behind it
};

}  // namespace treefarm
