// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/decide/next_event/next_event_sums.h"
#include "common/guiding/regions/refinement.h"
#include "common/guiding/regions/region_model.h"
#include "common/guiding/statistics/cell_sums.h"

namespace treefarm {

/// Decision on the number n of light samples per vertex, from kNextEventSamples, for each region, or for a whole image
/// without guiding (docs/design/guiding.md, "How often next event samples an emitter").

/// Sums of several passes; the weight of older ones halves with each pass.
using NextEventEvidence = std::array<double, kNextEventSums>;

/// Whether later trees will learn more about the light that light samples find.
enum class TreesLearn {
    nothing,  ///< no guide
    no_more,  ///< the tree of the next pass is the last
    on,
};

/// Evidence per region of a tree, in which regions with few vertices use the means of the enclosing cubes. The entry
/// for the spread becomes the variance of the known difference of the last moment and the first.
std::vector<NextEventEvidence> pool_next_event(const RegionModel& tree, std::span<const NextEventEvidence> evidence);

/// Sets `codes` (indices of kNextEventSamples) of regions so that variance times cost becomes least according to the
/// evidence, from `paths` camera samples. Fewer light samples must win by next_event.standard_errors (policy.h); they
/// are credited with next_event.learned as far as later trees learn the light that the others found, since the evidence
/// is of trees that may not know it yet. On entry `codes` holds the codes of the pass that gathered the last evidence.
/// Pure.
NextEventVerdict decide_next_event(std::span<const NextEventEvidence> evidence, double paths,
                                   const NextEventPrice& price, TreesLearn trees, std::span<std::uint8_t> codes);

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

/// Learner of the number of light samples of an image without guiding.
class ImageNextEventLearner {
  public:
    /// Turns the code of a pass with these sums into that of the next.
    NextEventVerdict learn(const NextEventSums& sums, const NextEventPrice& price, std::uint8_t& code);

    /// Archives the state, for a checkpoint.
    template <class Archive>
    void serialize(Archive& archive) {
        archive(evidence_, paths_);
    }

  private:
    NextEventEvidence evidence_{};
    double paths_ = 0;
};

}  // namespace treefarm
