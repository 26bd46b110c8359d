// SPDX-License-Identifier: Apache-2.0
#include "common/guiding/sd_tree/tree_learner.h"

namespace treefarm {

SdTree TreeLearner::learn(const SdTree& tree, const CellSums& sums, const RefineSettings& settings, bool learn_mixture,
                          RefineReport& report) {
    std::vector<ViewAdvice> advice;
    const bool learn_views = learn_mixture && tree.view_count() != 0;
    if (learn_views) advice = views_.judge(tree, sums, settings.last_update);
    SdTree next = refine(tree, sums, settings, report, advice);
    regions_.learn(tree, sums, settings, learn_mixture, report, next);
    if (learn_views) views_.set_fractions(report.view_origins, next);
    return next;
}

}  // namespace treefarm
