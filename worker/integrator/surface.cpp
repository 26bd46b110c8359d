#include "worker/integrator/surface.h"

#include <cassert>

namespace treefarm {

void GeneralSurface::look_up(const TraceScene& scene, const Hit& hit, std::int32_t material, bool back,
                             Scratch& scratch) {
    assert(scene.effects().textures || scene.effects().bump || scene.effects().anisotropy);
    if (!(wo_.z > 0.0f)) return;
    const SurfaceDetail detail = scene.geometry().detail(hit);
    const ShadingPoint point{detail.uv, frame_.to_local(detail.dp_du), frame_.to_local(detail.dp_dv), wo_, back};
    bsdf_ = scene.materials().look_up(material, back, point, scratch);
    lobes_ = lobes_of(*bsdf_);
    if (lobes_ == 0) bsdf_ = nullptr;
}

}  // namespace treefarm
