// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "common/config/job_keys.h"
#include "common/plan/effect_finder.h"
#include "common/plan/kernel.h"
#include "common/plan/memory.h"
#include "common/plan/schedule.h"
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

}  // namespace

void EffectFinder::add_shapes() {
    const auto add = [this](const char* name, const char* what, auto test, auto bytes) {
        finders_[name] = [this, what, test, bytes] {
            Effect effect =
                called_by(scene_.shapes, what, [&](const Shape& shape, std::size_t) { return test(shape); });
            effect.bytes = bytes();
            return effect;
        };
    };
    const auto is_mesh = [](const Shape& shape) { return std::holds_alternative<Mesh>(shape.geometry); };
    const auto is_instance = [](const Shape& shape) { return std::holds_alternative<Instance>(shape.geometry); };
    const auto is_analytic = [=](const Shape& shape) { return !is_mesh(shape) && !is_instance(shape); };
    const auto objects = [this](auto test) {
        return [this, test] {
            std::uint64_t bytes = 0;
            for (const Shape& shape : scene_.shapes)
                if (test(shape)) bytes += kHierarchyBytesPerObject;
            return bytes;
        };
    };
    add("triangles", "mesh", is_mesh, [this] {
        std::uint64_t bytes = kHierarchyBytesPerTriangle * scene_.triangle_count();
        for (const Shape& shape : scene_.shapes)
            if (const auto* mesh = std::get_if<Mesh>(&shape.geometry)) bytes += mesh_bytes(*mesh);
        return bytes;
    });
    add(
        "smooth_normals", "mesh with normals",
        [](const Shape& shape) {
            const auto* mesh = std::get_if<Mesh>(&shape.geometry);
            return mesh && !mesh->normals.empty();
        },
        [this] { return normal_bytes(scene_); });
    add("analytic_shapes", "analytic shape", is_analytic, objects(is_analytic));
    add("instances", "instance", is_instance, objects(is_instance));
    finders_["masks"] = [this] {
        return called_by(scene_.materials, "masked material",
                         [this](const Material& m, std::size_t i) { return used_directly_[i] && m.masked(); });
    };
    finders_["lens"] = [this] {
        if (!scene_.camera.has_lens())
            return effect_off(scene_.camera.panoramic           ? "the camera is panoramic"
                              : scene_.camera.is_orthographic() ? "the camera is orthographic"
                                                                : "the camera is a pinhole");
        return effect_on("the camera has a lens");
    };
    finders_["pixel_filter"] = [this] {
        if (is_box_of_one_pixel(scene_.film)) return effect_off("the film has a box filter of one pixel");
        return effect_on("the film has a " + filter_text(scene_.film));
    };
}

void EffectFinder::add_transport() {
    finders_["guiding"] = [this] {
        if (!job_.guides) return effect_off("guiding.type = \"none\"");
        const std::size_t passes = plan_passes(job_).size();
        if (passes < 2) return effect_off("a single pass has nothing to learn from");
        return effect_on("guiding.type = \"" + guiding_word(job_) + "\", " + std::to_string(passes - 1) + " of " +
                             std::to_string(passes) + " passes",
                         expected_tree(scene_, job_).guide_bytes());
    };
    finders_["views"] = [this] {
        if (job_.guiding.type != GuidingType::view) return effect_off("guiding.type is neither \"view\" nor \"auto\"");
        if (!job_.learns_views) return effect_off("no surface prefers other directions from another side");
        if (plan_passes(job_).size() < 2) return effect_off("a single pass has nothing to learn from");
        return effect_on("rough materials, " + std::to_string(expected_tree(scene_, job_).views) + " views expected");
    };
    finders_["recording"] = [this] {
        std::size_t count = 0;
        for (const PassPlan& pass : plan_passes(job_))
            count += pass.record ? 1 : 0;
        if (count == 0) return effect_off("no later pass would be guided by it");
        return effect_on("in all passes but the last, " + std::to_string(count) + " of them",
                         expected_tree(scene_, job_).sum_bytes());
    };
    finders_["roulette"] = [this] {
        const int depth = job_.integrator.max_depth, from = job_.integrator.rr_depth;
        if (depth >= 0 && from >= depth)
            return effect_off("paths end at depth " + std::to_string(depth) +
                              " before integrator.rr_depth = " + std::to_string(from));
        return effect_on("integrator.rr_depth = " + std::to_string(from));
    };
    finders_["depth_limit"] = [this] {
        const std::string reason = "integrator.max_depth = " + std::to_string(job_.integrator.max_depth);
        return job_.integrator.max_depth < 0 ? effect_off(reason) : effect_on(reason);
    };
    finders_["strict_normals"] = [this] {
        return by_switch(job_.integrator.strict_normals, "integrator.strict_normals");
    };
    finders_["hidden_emitters"] = [this] {
        return by_switch(job_.integrator.hide_emitters, "integrator.hide_emitters");
    };
}

}  // namespace treefarm
