// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstring>

#include "worker/geometry/embree_api.h"
#include "worker/geometry/ray.h"

namespace treefarm {

/// Writes four floats at once, as Embree will read them: a processor that finds what it reads in pieces among its last
/// writes waits until they have reached the cache (bench/log/speed.md, "what made paths faster").
inline void write_together(float* to, const Vec3& v, float fourth) {
    using Four [[gnu::vector_size(16)]] = float;
    const Four four = {v.x, v.y, v.z, fourth};
    std::memcpy(to, &four, sizeof four);
}

/// A ray as Embree wants it.
inline RTCRay to_embree(const Ray& ray) {
    RTCRay r;
    write_together(&r.org_x, ray.origin, 0.0f);     // the fourth is tnear
    write_together(&r.dir_x, ray.direction, 0.0f);  // time
    r.tfar = ray.length;
    r.mask = ~0u;
    r.id = 0;
    r.flags = 0;
    return r;
}

}  // namespace treefarm
