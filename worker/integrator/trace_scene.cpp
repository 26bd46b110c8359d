#include "worker/integrator/trace_scene.h"

namespace treefarm {
namespace {

std::vector<Bsdf> shape_bsdfs(const Scene& scene) {
    std::vector<Bsdf> bsdfs;
    bsdfs.reserve(scene.shapes.size());
    for (const Shape& shape : scene.shapes)
        bsdfs.push_back(make_bsdf(scene, shape.material));
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

}  // namespace

TraceScene::TraceScene(Scene scene, const Job& job) : TraceScene(std::move(scene), shape_opacity(scene), job) {}

TraceScene::TraceScene(Scene&& scene, const std::vector<FloatInput>& opacity, const Job& job)
    : film_(scene.film),
      camera_(scene.camera, scene.film),
      bsdfs_(shape_bsdfs(scene)),
      bounds_(scene.bounds()),
      textures_(std::move(scene.textures), std::move(scene.images)),
      geometry_(std::move(scene.shapes), job.farm.isa, {opacity, &textures_}),
      emitters_(scene.emitters, geometry_, bounds_, &textures_) {}

}  // namespace treefarm
