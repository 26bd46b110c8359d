// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/guiding/regions/refinement.h"
#include "common/guiding/regions/region_model.h"
#include "common/guiding/statistics/cell_sums.h"
#include "common/math/next_event_sums.h"

namespace treefarm {

/// The decision how often next event samples an emitter at a vertex: n of kNextEventSamples, for each region, or for a
/// whole image that nothing guides (docs/design/guiding.md, "How often next event samples an emitter").

/// Sums of several passes in doubles; older ones count half as much with each.
using NextEventEvidence = std::array<double, kNextEventSums>;

/// Whether trees to come will know more of the light that light samples find.
enum class TreesLearn {
    nothing,  ///< there is no tree
    no_more,  ///< the tree of the coming pass is the last
    on,
};

/// Evidence of the regions of a tree, in which those that know few vertices lean on the cubes about them. The spread
/// becomes the variance of what is known of the last moment less the first.
std::vector<NextEventEvidence> pool_next_event(const RegionModel& tree, std::span<const NextEventEvidence> evidence);

/// Sets codes (indices of kNextEventSamples) of regions with this evidence, from `paths` camera samples, so that
/// variance times cost becomes least, as far as it is known: fewer light samples have to win by
/// next_event.standard_errors (policy.h). Fewer light samples are credited with next_event.learned as far as trees
/// learn what the others found: the evidence is of trees that need not know it yet. `codes` are those that the last
/// evidence was gathered with. Pure.
NextEventVerdict decide_next_event(std::span<const NextEventEvidence> evidence, double paths,
                                   const NextEventPrice& price, TreesLearn trees, std::span<std::uint8_t> codes);

/// The coordinator's memory of what next event was worth in each region, from pass to pass.
class NextEventLearner {
  public:
    /// Sets next.next_event from what the pass over `tree` counted. `report` has the origins of the regions, and gets
    /// the verdict.
    void learn(const RegionModel& tree, const CellSums& sums, const RefineSettings& settings, RefineReport& report,
               RegionModel& next);

    /// Lists what it remembers, for a checkpoint.
    template <class Archive>
    void serialize(Archive& archive) {
        archive(evidence_, paths_);
    }

  private:
    std::vector<NextEventEvidence> evidence_;  ///< per region of the coming tree
    double paths_ = 0;                         ///< camera samples behind it
};

/// As NextEventLearner, for an image that nothing guides.
class ImageNextEventLearner {
  public:
    /// Turns the code of a pass with these sums into that of the next.
    NextEventVerdict learn(const NextEventSums& sums, const NextEventPrice& price, std::uint8_t& code);

    /// Lists what it remembers, for a checkpoint.
    template <class Archive>
    void serialize(Archive& archive) {
        archive(evidence_, paths_);
    }

  private:
    NextEventEvidence evidence_{};
    double paths_ = 0;
};

}  // namespace treefarm
