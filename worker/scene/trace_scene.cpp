// SPDX-License-Identifier: Apache-2.0
#include "worker/scene/trace_scene.h"

#include <cassert>

#include "common/plan/schedule/learning.h"
#include "common/scene/uses/material_traits.h"

namespace treefarm {
namespace {

/// Whether surfaces need not be told apart: there are kernels for no others.
bool traced_plainly(const Scene& scene, const Job& job) {
    return is_plainly_diffuse(scene) && has_plain_kernels(guide_kind(job));
}

/// Per shape of a plainly diffuse scene; a shape without material is black.
std::vector<PlainDiffuse> diffuse_bsdfs(const Scene& scene) {
    std::vector<PlainDiffuse> bsdfs(scene.shapes.size());
    for (std::size_t i = 0; i < bsdfs.size(); ++i) {
        const std::int32_t material = scene.shapes[i].material;
        if (material == kNone) continue;
        const Material& m = scene.materials[static_cast<std::size_t>(material)];
        bsdfs[i] = {std::get<DiffuseMaterial>(m.bsdf).reflectance.value, m.twosided};
    }
    return bsdfs;
}

/// Per shape; empty if no shape is masked.
std::vector<FloatInput> shape_opacity(const Scene& scene) {
    std::vector<FloatInput> opacity;
    for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
        const std::int32_t material = scene.shapes[i].material;
        if (material == kNone || !scene.materials[static_cast<std::size_t>(material)].masked()) continue;
        if (opacity.empty()) opacity.resize(scene.shapes.size(), FloatInput(1.0f));
        opacity[i] = scene.materials[static_cast<std::size_t>(material)].opacity;
    }
    return opacity;
}

std::optional<MaterialSet> make_materials(const Scene& scene, const Job& job, const TextureSet& textures) {
    if (traced_plainly(scene, job)) return std::nullopt;
    return std::optional<MaterialSet>(std::in_place, scene, textures);
}

}  // namespace

TraceScene::TraceScene(Scene scene, const Job& job) : TraceScene(std::move(scene), shape_opacity(scene), job) {}

TraceScene::TraceScene(Scene&& scene, const std::vector<FloatInput>& opacity, const Job& job)
    : effects_(find_scene_effects(scene, job)),
      film_(scene.film),
      camera_(scene.camera, scene.film),
      bounds_(scene.bounds()),
      textures_(std::move(scene.textures), std::move(scene.images)),
      plain_diffuse_(traced_plainly(scene, job) ? diffuse_bsdfs(scene) : std::vector<PlainDiffuse>()),
      materials_(make_materials(scene, job, textures_)),
      geometry_(textures_.arranged(std::move(scene.shapes)), job.farm.isa, {opacity, &textures_}, job.farm.robust),
      emitters_(scene.emitters, geometry_, bounds_, &textures_, job.integrator.light_selection) {
    assert(effects_.lens == camera_.has_lens());
    assert(effects_.masks == geometry_.masked());
    assert(effects_.environment || !emitters_.shines_from_infinity());
}

}  // namespace treefarm
