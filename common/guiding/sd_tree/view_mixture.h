// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "common/guiding/regions/mixture.h"
#include "common/guiding/sd_tree/refine.h"
#include "common/guiding/statistics/cell_sums.h"

namespace treefarm {

/// Probability a_2 of sampling T2 at vertices with a view. The alternative is q = a_B p_B + (1 - a_B) p_1, the mixture
/// that the region learns on its own (mixture.h). A direction is drawn from p_s = a_2 p_2 + (1 - a_2) q. a_2 is
/// learned like a_B, with q in place of the BSDF and p_2 in place of the tree. So a view without evidence leaves its
/// region unchanged, and a view shared by many regions does not affect what each of them has learned.

/// Gain of a mixture with a share `others` of q over q alone, by the fit to the histogram: nats per record, about twice
/// the relative excess of variance while small. 0 for an empty histogram.
double view_gain(const MixtureHistogram& histogram, double others);

/// Learner of views.
class ViewLearner {
  public:
    /// Adds the records of the pass over `tree`. Returns advice about its views, for refine(). A T2 gets a second
    /// chance, except in the `last_update`.
    std::vector<ViewAdvice> judge(const SdTree& tree, const CellSums& sums, bool last_update);
    /// Sets the fractions of the refined tree's views. `origins` as in RefineReport.
    void set_fractions(std::span<const ViewOrigin> origins, SdTree& next);

    /// Archives the state, for a checkpoint.
    template <class Archive>
    void serialize(Archive& archive) {
        archive(views_);
    }

  private:
    struct Evidence {
        MixtureHistogram histogram{};  ///< sums in the unit of records, not in quanta
        int idle_passes = 0;           ///< passes in which T2 was hardly worth sampling
        double others = 1.0;           ///< share of q

        template <class Archive>
        void serialize(Archive& archive) {
            archive(histogram, idle_passes, others);
        }
    };
    std::vector<Evidence> views_;  ///< of the next tree
};

}  // namespace treefarm
