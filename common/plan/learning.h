// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/guiding/sd_tree/refine.h"
#include "common/guiding/sd_tree/sd_tree.h"
#include "common/plan/schedule.h"

namespace treefarm {

/// The tree before the first pass over `bounds`; a record of average value is about `radiance_scale`.
SdTree first_tree(const Resolved& job, const Box3& bounds, float radiance_scale);
/// The first tree, over all that the scene's camera can see.
SdTree first_tree(const Resolved& job, const Scene& scene);

/// How the job refines the tree after `pass` for the `coming` one.
RefineSettings refine_settings(const Resolved& job, const PassPlan& pass, const PassPlan& coming);

/// Shape of the sums of a pass over `tree`.
SumsShape sums_shape(const PassPlan& pass, const SdTree& tree);

}  // namespace treefarm
