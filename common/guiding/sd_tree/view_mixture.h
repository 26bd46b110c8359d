// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "common/guiding/regions/mixture.h"
#include "common/guiding/sd_tree/refine.h"
#include "common/guiding/statistics/cell_sums.h"

namespace treefarm {

/// How often to sample T2 where a view guides. It stands beside what its region does without it, q = a_B p_B + (1 -
/// a_B) p_1, whose mixture every region learns for itself (mixture.h): a direction is drawn from p_s = a_2 p_2 + (1 -
/// a_2) q, and a_2 is learned as a_B is, q in the place of the BSDF and p_2 in that of the tree. So a view without
/// evidence leaves its region as it is, and views that are shared by many regions take nothing from what each of those
/// knows.

/// How much better a mixture with so much of q fits the histogram than q alone: nats per record, about twice the
/// relative excess of variance where it is small. 0 for an empty histogram.
double view_gain(const MixtureHistogram& histogram, double others);

/// The coordinator's memory of views from pass to pass.
class ViewLearner {
  public:
    /// Adds what the pass over `tree` recorded; returns advice about its views, for refine(). A T2 gets a second
    /// chance, but for the `last_update`.
    std::vector<ViewAdvice> judge(const SdTree& tree, const CellSums& sums, bool last_update);
    /// Sets the fractions of the refined tree's views. `origins` as in RefineReport.
    void set_fractions(std::span<const ViewOrigin> origins, SdTree& next);

    /// Lists what it remembers, for a checkpoint.
    template <class Archive>
    void serialize(Archive& archive) {
        archive(views_);
    }

  private:
    struct Evidence {
        MixtureHistogram histogram{};  ///< in what it records, not in quanta
        int idle_passes = 0;           ///< in which T2 was hardly worth sampling
        double others = 1.0;           ///< the part of q

        template <class Archive>
        void serialize(Archive& archive) {
            archive(histogram, idle_passes, others);
        }
    };
    std::vector<Evidence> views_;  ///< of the coming tree
};

}  // namespace treefarm
