// SPDX-License-Identifier: Apache-2.0
#include "common/plan/schedule/learning.h"

#include <cmath>

#include "common/base/policy.h"

namespace treefarm {

GuideKind guide_kind(const Job& job) {
    switch (job.guiding.type) {
        case GuidingType::none:
        case GuidingType::ppg:
        case GuidingType::view:
        case GuidingType::automatic:
            return GuideKind::sd_tree;
        case GuidingType::grid:
            return GuideKind::grid;
        case GuidingType::qtable:
            return GuideKind::qtable;
    }
    return {};
}

bool has_plain_kernels(GuideKind guide) {
    bool plain = false;
    with_guide(guide, [&]<class G>() { plain = G::kPlainKernels; });
    return plain;
}

AnyModel first_model(const Resolved& job, const Box3& bounds, float radiance_scale) {
    FirstModel first;
    first.radiance_scale =
        job.guiding.target == GuidingTarget::variance ? radiance_scale * radiance_scale : radiance_scale;
    first.bsdf_fraction = job.guiding.bsdf_fraction;
    first.with_views = job.learns_views;
    first.view_fraction = job.guiding.learn_bsdf_fraction ? 0.0f : 1.0f - job.guiding.bsdf_fraction;
    first.with_lights = job.learns_lights;
    first.grid_halvings = job.guiding.grid_halvings;
    AnyModel model = AnyModel::first(guide_kind(job), bounds, first);
    model.set_decides_next_event(job.guides && job.decides_next_event);
    return model;
}

AnyModel first_model(const Resolved& job, const Scene& scene) {
    Box3 bounds = scene.bounds();
    bounds.extendBy(scene.camera.origin);
    return first_model(job, bounds, scene.radiance_scale());
}

RefineSettings refine_settings(const Resolved& job, const PassPlan& pass, const PassPlan& coming) {
    RefineSettings settings;
    settings.spatial_threshold = spatial_split_threshold(job, coming);
    settings.directional_divisor =
        static_cast<std::uint32_t>(std::lround(1.0 / static_cast<double>(job.guiding.directional_threshold)));
    settings.record_weight = pass.record_weight;
    settings.target = job.guiding.target;
    settings.with_flux = job.guiding.bootstrap > 0.0f;
    settings.view_threshold = split_growth(job, coming) * job.guiding.view_threshold;
    settings.last_update = coming.last_tree;
    settings.views_record_alone = job.guiding.view_records == ViewRecords::radiance;
    if (job.cells_follow_use) settings.least_use = tuned("learning.least_use");
    if (job.guiding.view_records == ViewRecords::product) {
        settings.view_set_threshold = settings.view_threshold;
        settings.least_view_cells = tuned("learning.free_cells");
        settings.view_cells = tuned("learning.product_cells");
    }
    return settings;
}

Evidence no_evidence(const PassPlan& pass, const AnyModel& model) {
    std::vector<Blocks> owners{Decisions::blocks()};
    if (pass.record) owners.push_back(model.blocks(pass.index, pass.learn_mixture));
    return {pass.index, std::move(owners)};
}

}  // namespace treefarm
