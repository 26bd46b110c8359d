#pragma once

#include "common/guiding/refine.h"
#include "common/guiding/sd_tree.h"
#include "common/plan/schedule.h"
#include "common/scene/scene.h"

namespace treefarm {

/// Whether next event learns how to choose emitters: the job asks for it, and there is a choice.
bool learns_lights(const Scene& scene, const Job& job);

/// Whether regions get fewer cells where the BSDF is sampled rather than their tree.
bool cells_follow_use(const Job& job);

/// The tree before the first pass over `bounds`; a record of average value is about `radiance_scale`.
SdTree first_tree(const Scene& scene, const Job& job, const Box3& bounds, float radiance_scale);

/// How the job refines the tree of a film of so many pixels after `pass` for the `coming` one.
RefineSettings refine_settings(const Job& job, double film_pixels, const PassPlan& pass, const PassPlan& coming);

/// What a pass over `tree` sums up.
SumsShape sums_shape(const PassPlan& pass, const SdTree& tree);

}  // namespace treefarm
