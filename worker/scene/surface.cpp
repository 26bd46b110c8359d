// SPDX-License-Identifier: Apache-2.0
#include "worker/scene/surface.h"

#include <cassert>

namespace treefarm {

void GeneralSurface::look_up(const TraceScene& scene, const Hit& hit, std::int32_t material, bool back, bool flat,
                             Scratch& scratch) {
    assert(scene.effects().textures || scene.effects().bump || scene.effects().anisotropy);
    if (!(wo_.z > 0.0f)) return;
    ShadingPoint point;
    point.wo = wo_;
    point.mirrored = back;
    point.flat = flat;
    MeshPoint on_mesh;
    if (scene.textures().reads_meshes()) {
        on_mesh = scene.geometry().mesh_point(hit);
        point.on_mesh = &on_mesh;
    }
    if (scene.materials().needs_tangents(material)) {
        const SurfaceDetail detail = scene.geometry().detail(hit);
        point.uv = detail.uv;
        point.dp_du = frame_.to_local(detail.dp_du);
        point.dp_dv = frame_.to_local(detail.dp_dv);
    } else {
        point.uv = scene.geometry().uv(hit);
    }
    bsdf_ = scene.materials().look_up(material, back, point, scratch);
    lobes_ = lobes_of(*bsdf_);
    if (lobes_ == 0) bsdf_ = nullptr;
}

void GeneralSurface::prefetch(const TraceScene& scene, const Hit& hit, std::int32_t material) {
    const std::int32_t texture = scene.materials().first_texture(material);
    if (texture != kNone) scene.textures().prefetch(texture, scene.geometry().uv(hit));
}

}  // namespace treefarm
