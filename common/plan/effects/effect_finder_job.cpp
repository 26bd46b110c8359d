// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "common/config/estimators.h"
#include "common/config/job_keys.h"
#include "common/plan/effects/effect_finder.h"
#include "common/plan/forecast/memory.h"
#include "common/plan/schedule/kernel.h"
#include "common/plan/schedule/schedule.h"
#include "common/scene/model/filter_lobes.h"

namespace treefarm {
namespace {

bool is_box_of_one_pixel(const Film& film) {
    return film.filter == PixelFilter::box && film.filter_radius == 0.5f;
}

std::string filter_text(const Film& film) {
    const auto with_lobes = [&](const char* name) {
        char text[96];
        std::snprintf(text, sizeof(text), "%s filter, whose negative lobes multiply the squares of samples by %.2f",
                      name, sign_cost(film));
        return std::string(text);
    };
    switch (film.filter) {
        case PixelFilter::tent:
            return "tent filter";
        case PixelFilter::gaussian:
            return "Gaussian filter";
        case PixelFilter::cubic:
            return with_lobes("cubic");
        case PixelFilter::lanczos:
            return with_lobes("Lanczos");
        case PixelFilter::box:
            break;
    }
    return "wide box filter";
}

Effect by_switch(bool value, const std::string& key) {
    const std::string reason = key + " = " + (value ? "true" : "false");
    return value ? effect_on(reason) : effect_off(reason);
}

std::uint64_t normal_bytes(const Scene& scene) {
    std::uint64_t bytes = 0;
    for (const Shape& shape : scene.shapes)
        if (const auto* mesh = std::get_if<Mesh>(&shape.geometry)) bytes += mesh->normals.size() * sizeof(Vec3);
    return bytes;
}

/// Whether paths from the camera and from emitters are connected.
bool connects(const Resolved& job) {
    return estimator_of(job.integrator.type).from == PathsFrom::both;
}

bool is_mesh(const Shape& shape) {
    return std::holds_alternative<Mesh>(shape.geometry);
}

bool is_instance(const Shape& shape) {
    return std::holds_alternative<Instance>(shape.geometry);
}

}  // namespace

template <class Test>
Effect EffectFinder::objects(const std::string& what, Test test) const {
    Effect effect = shapes(what, test);
    for (const Shape& shape : scene_.shapes)
        if (test(shape)) effect.bytes += kHierarchyBytesPerObject;
    return effect;
}

Effect EffectFinder::triangles() const {
    Effect effect = shapes("mesh", is_mesh);
    effect.bytes = kHierarchyBytesPerTriangle * scene_.triangle_count();
    for (const Shape& shape : scene_.shapes)
        if (const auto* mesh = std::get_if<Mesh>(&shape.geometry)) effect.bytes += mesh_bytes(*mesh);
    return effect;
}

Effect EffectFinder::smooth_normals() const {
    Effect effect = shapes("mesh with normals", [](const Shape& shape) {
        const auto* mesh = std::get_if<Mesh>(&shape.geometry);
        return mesh && !mesh->normals.empty();
    });
    effect.bytes = normal_bytes(scene_);
    return effect;
}

Effect EffectFinder::analytic_shapes() const {
    return objects("analytic shape", [](const Shape& shape) { return !is_mesh(shape) && !is_instance(shape); });
}

Effect EffectFinder::instances() const {
    return objects("instance", is_instance);
}

Effect EffectFinder::masks() const {
    return called_by(scene_.materials, "masked material",
                     [this](const Material& m, std::size_t i) { return used_directly_[i] && m.masked(); });
}

Effect EffectFinder::lens() const {
    if (!scene_.camera.has_lens())
        return effect_off(scene_.camera.panoramic           ? "the camera is panoramic"
                          : scene_.camera.is_orthographic() ? "the camera is orthographic"
                                                            : "the camera is a pinhole");
    return effect_on("the camera has a lens");
}

Effect EffectFinder::pixel_filter() const {
    if (is_box_of_one_pixel(scene_.film)) return effect_off("the film has a box filter of one pixel");
    return effect_on("the film has a " + filter_text(scene_.film));
}

Effect EffectFinder::guiding() const {
    if (!job_.guides) return effect_off("guiding.type = \"none\"");
    const std::size_t passes = plan_passes(job_).size();
    if (passes < 2) return effect_off("a single pass has nothing to learn from");
    return effect_on("guiding.type = \"" + guiding_word(job_) + "\", " + std::to_string(passes - 1) + " of " +
                         std::to_string(passes) + " passes",
                     expected_tree(scene_, job_).guide_bytes());
}

Effect EffectFinder::views() const {
    if (job_.guiding.type != GuidingType::view) return effect_off(R"(guiding.type is neither "view" nor "auto")");
    if (!job_.learns_views) return effect_off("no surface prefers other directions from another side");
    if (plan_passes(job_).size() < 2) return effect_off("a single pass has nothing to learn from");
    return effect_on("surfaces that prefer other directions from another side, " +
                     std::to_string(expected_tree(scene_, job_).views) + " views expected");
}

Effect EffectFinder::recording() const {
    std::size_t count = 0;
    for (const PassPlan& pass : plan_passes(job_))
        count += pass.record ? 1 : 0;
    if (count == 0) return effect_off("no later pass would be guided by it");
    return effect_on("in all passes but the last, " + std::to_string(count) + " of them",
                     expected_tree(scene_, job_).sum_bytes());
}

Effect EffectFinder::light_subpaths() const {
    const std::string reason = "integrator.type = \"" + job_.integrator.type + "\"";
    if (!estimator_of(job_.integrator.type).splats()) return effect_off(reason);
    if (scene_.emitters.empty()) return effect_off("there are no emitters");
    const bool for_now = job_.bidirectional.light_subpaths == Rule::while_it_pays && connects(job_);
    return effect_on(reason + (for_now ? ", until passes show that they do not pay" : ""));
}

Effect EffectFinder::light_image() const {
    if (!light_subpaths().on) return effect_off("there are no paths from emitters");
    if (!connects(job_)) return effect_on("all that the image shows", splat_bytes(scene_, job_));
    if (!job_.bidirectional.light_image) return effect_off("bidirectional.light_image = false");
    return effect_on("bidirectional.light_image = true", splat_bytes(scene_, job_));
}

Effect EffectFinder::connections() const {
    if (!light_subpaths().on) return effect_off("there are no paths from emitters");
    if (!connects(job_)) return effect_off("there are no paths from the camera");
    return effect_on("bidirectional.techniques = \"" + job_.bidirectional.techniques + "\"");
}

Effect EffectFinder::roulette() const {
    const int depth = job_.integrator.max_depth, from = job_.integrator.rr_depth;
    if (depth >= 0 && from >= depth)
        return effect_off("paths end at depth " + std::to_string(depth) +
                          " before integrator.rr_depth = " + std::to_string(from));
    return effect_on("integrator.rr_depth = " + std::to_string(from));
}

Effect EffectFinder::depth_limit() const {
    const std::string reason = "integrator.max_depth = " + std::to_string(job_.integrator.max_depth);
    return job_.integrator.max_depth < 0 ? effect_off(reason) : effect_on(reason);
}

Effect EffectFinder::strict_normals() const {
    return by_switch(job_.integrator.strict_normals, "integrator.strict_normals");
}

Effect EffectFinder::hidden_emitters() const {
    return by_switch(job_.integrator.hide_emitters, "integrator.hide_emitters");
}

}  // namespace treefarm
