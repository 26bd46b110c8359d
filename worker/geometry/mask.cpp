// SPDX-License-Identifier: Apache-2.0
#include "worker/geometry/mask.h"

#include <bit>

#include "common/base/hash.h"
#include "common/base/random.h"
#include "worker/geometry/embree_api.h"
#include "worker/geometry/embree_ray.h"
#include "worker/geometry/surface_detail.h"

namespace treefarm {
namespace {

/// Hash of a ray and a hit, uniform in [0, 1).
float decision(const RTCRay& ray, const RTCHit& hit, std::uint32_t shape) {
    std::uint64_t h = 0x9e3779b97f4a7c15ULL;
    const auto add = [&](std::uint32_t a, std::uint32_t b) { h = mix_bits(h ^ (std::uint64_t(a) << 32 | b)); };
    const auto bits = [](float f) { return std::bit_cast<std::uint32_t>(f); };
    add(bits(ray.org_x), bits(ray.org_y));
    add(bits(ray.org_z), bits(ray.dir_x));
    add(bits(ray.dir_y), bits(ray.dir_z));
    add(bits(hit.u), bits(hit.v));
    add(bits(hit.Ng_x), bits(hit.Ng_y));
    add(bits(hit.Ng_z), hit.primID);
    add(shape, hit.instID[0]);
    return to_unit(static_cast<std::uint32_t>(h >> 32));
}

void filter(const RTCFilterFunctionNArguments* args) {
    const Mask& mask = *static_cast<const Mask*>(args->geometryUserPtr);
    for (unsigned i = 0; i < args->N; ++i) {
        if (args->valid[i] == 0) continue;
        const RTCRay ray = rtcGetRayFromRayN(args->ray, args->N, i);
        const RTCHit hit = rtcGetHitFromHitN(args->hit, args->N, i);
        if (!mask.accepts(&ray, &hit)) args->valid[i] = 0;
    }
}

}  // namespace

float Mask::opacity_at(std::uint32_t primitive, float b1, float b2, const Vec3& outward) const {
    float value = opacity.value;
    if (opacity.varies()) {
        const MeshPoint on_mesh =
            textures->reads_meshes() ? MeshPoint{std::get_if<Mesh>(&shape->geometry), primitive, b1, b2} : MeshPoint();
        value *= textures->value(opacity.texture, {shape_uv(*shape, primitive, b1, b2, outward), &on_mesh});
    }
    if (!(value < 1.0f)) return 1.0f;
    return value > 0.0f ? value : 0.0f;
}

bool Mask::accepts(const void* ray, const void* hit) const {
    const RTCHit& h = *static_cast<const RTCHit*>(hit);
    if (hidden && static_cast<const RTCRay*>(ray)->id == kCameraRay) return false;
    const float value = opacity_at(h.primID, h.u, h.v, {h.Ng_x, h.Ng_y, h.Ng_z});
    if (value >= 1.0f) return true;
    if (value <= 0.0f) return false;
    return decision(*static_cast<const RTCRay*>(ray), h, shape_index) < value;
}

void set_mask_filter(RTCGeometry geometry, const Mask& mask) {
    rtcSetGeometryUserData(geometry, const_cast<Mask*>(&mask));
    rtcSetGeometryIntersectFilterFunction(geometry, filter);
    rtcSetGeometryOccludedFilterFunction(geometry, filter);
}

}  // namespace treefarm
