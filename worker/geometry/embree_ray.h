// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstring>

#include "worker/geometry/embree_api.h"
#include "worker/geometry/ray.h"

namespace treefarm {

/// Writes four floats with one store, as Embree reads them: a load that spans several recent stores stalls until they
/// have reached the cache (bench/log/speed.md, "what made paths faster").
inline void write_together(float* to, const Vec3& v, float fourth) {
    using Four [[gnu::vector_size(16)]] = float;
    const Four four = {v.x, v.y, v.z, fourth};
    std::memcpy(to, &four, sizeof four);
}

/// Embree's ray id of camera rays, by which masks tell them.
inline constexpr unsigned kCameraRay = 1;

/// Embree's form of a ray.
inline RTCRay to_embree(const Ray& ray) {
    RTCRay r;
    write_together(&r.org_x, ray.origin, 0.0f);     // the fourth float is tnear
    write_together(&r.dir_x, ray.direction, 0.0f);  // the fourth float is time
    r.tfar = ray.length;
    r.mask = ~0u;
    r.id = ray.of_camera ? kCameraRay : 0;
    r.flags = 0;
    return r;
}

}  // namespace treefarm
