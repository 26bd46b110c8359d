// SPDX-License-Identifier: Apache-2.0
#include "common/plan/learning.h"

#include <cmath>

#include "common/plan/policy.h"

namespace treefarm {
SdTree first_tree(const Resolved& job, const Box3& bounds, float radiance_scale) {
    const float a = job.guiding.bsdf_fraction;
    return initial_tree(
        bounds, {job.guiding.target == GuidingTarget::variance ? radiance_scale * radiance_scale : radiance_scale, a,
                 job.learns_views, job.guiding.learn_bsdf_fraction ? 0.0f : 1.0f - a, job.learns_lights});
}

SdTree first_tree(const Resolved& job, const Scene& scene) {
    Box3 bounds = scene.bounds();
    bounds.extendBy(scene.camera.origin);
    return first_tree(job, bounds, scene.radiance_scale());
}

RefineSettings refine_settings(const Resolved& job, const PassPlan& pass, const PassPlan& coming) {
    RefineSettings settings;
    settings.spatial_threshold = spatial_split_threshold(job, coming);
    settings.directional_divisor =
        static_cast<std::uint32_t>(std::lround(1.0 / static_cast<double>(job.guiding.directional_threshold)));
    settings.record_weight = pass.record_weight;
    settings.target = job.guiding.target;
    settings.view_threshold = split_growth(job, coming) * job.guiding.view_threshold;
    settings.last_update = coming.last_tree;
    settings.views_record_alone = job.guiding.view_records == ViewRecords::radiance;
    if (job.cells_follow_use) settings.least_use = kPolicy.learning.least_use;
    if (job.guiding.view_records == ViewRecords::product) {
        settings.view_set_threshold = settings.view_threshold;
        settings.least_view_cells = kPolicy.learning.free_cells;
        settings.view_cells = kPolicy.learning.product_cells;
    }
    return settings;
}

SumsShape sums_shape(const PassPlan& pass, const SdTree& tree) {
    return {tree.region_count(), tree.cell_count(), pass.learn_mixture, tree.view_count(),
            !tree.light_probabilities.empty()};
}

}  // namespace treefarm
