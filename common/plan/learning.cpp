#include "common/plan/learning.h"

#include <algorithm>
#include <cmath>

#include "common/plan/kernel.h"

namespace treefarm {
namespace {

/// Cells of views that learn products, over those of all regions.
constexpr double kProductCells = 0.5;
/// As many are never too many: half a megabyte.
constexpr double kFreeCells = 1 << 16;
/// Of a region's cells, what is left where the BSDF is sampled instead (docs/design/guiding.md, "Cells by use").
constexpr double kLeastUse = 0.5;

}  // namespace

bool learns_lights(const Scene& scene, const Job& job) {
    const bool learned = job.guiding.light_selection == LightSelection::learned ||
                         (job.guiding.light_selection == LightSelection::usual && uses_views(job.guiding.type));
    if (!learned || job.guiding.type == GuidingType::none || job.integrator.next_event == NextEvent::never)
        return false;
    const bool with_image = std::any_of(scene.emitters.begin(), scene.emitters.end(), [](const Emitter& emitter) {
        return std::holds_alternative<EnvironmentEmitter>(emitter.kind);
    });
    return with_image || scene.emitters.size() > 1;
}

bool cells_follow_use(const Job& job) {
    return uses_views(job.guiding.type) && job.guiding.view_records == ViewRecords::product &&
           job.guiding.learn_bsdf_fraction;
}

SdTree first_tree(const Scene& scene, const Job& job, const Box3& bounds, float radiance_scale) {
    const float a = job.guiding.bsdf_fraction;
    return initial_tree(
        bounds,
        {job.guiding.target == GuidingTarget::variance ? radiance_scale * radiance_scale : radiance_scale, a,
         learns_views(scene, job), job.guiding.learn_bsdf_fraction ? 0.0f : 1.0f - a, learns_lights(scene, job)});
}

RefineSettings refine_settings(const Job& job, double film_pixels, const PassPlan& pass, const PassPlan& coming) {
    RefineSettings settings;
    settings.spatial_threshold = spatial_split_threshold(job, film_pixels, coming);
    settings.directional_divisor =
        static_cast<std::uint32_t>(std::lround(1.0 / static_cast<double>(job.guiding.directional_threshold)));
    settings.record_weight = pass.record_weight;
    settings.target = job.guiding.target;
    settings.view_threshold = split_growth(job, coming) * job.guiding.view_threshold;
    settings.last_lesson = !coming.record;
    settings.views_record_alone = job.guiding.view_records == ViewRecords::radiance;
    if (cells_follow_use(job)) settings.least_use = kLeastUse;
    if (job.guiding.view_records == ViewRecords::product) {
        settings.view_set_threshold = settings.view_threshold;
        settings.least_view_cells = kFreeCells;
        settings.view_cells = kProductCells;
    }
    return settings;
}

SumsShape sums_shape(const PassPlan& pass, const SdTree& tree) {
    return {tree.region_count(), tree.cell_count(), pass.learn_mixture, tree.view_count(), !tree.light_share.empty()};
}

}  // namespace treefarm
