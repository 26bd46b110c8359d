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

}  // namespace

TraceScene::TraceScene(Scene scene, const Job& job)
    : film_(scene.film),
      camera_(scene.camera, scene.film),
      bsdfs_(shape_bsdfs(scene)),
      bounds_(scene.bounds()),
      geometry_(std::move(scene.shapes), job.farm.isa),
      emitters_(scene.emitters, geometry_, bounds_) {}

}  // namespace treefarm
