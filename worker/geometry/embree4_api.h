// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <embree4/rtcore.h>

#include <cstdint>
#include <span>

namespace treefarm {

/// Ray queries with Embree 4: see embree_api.h. Its default arguments are for incoherent rays.
class EmbreeRays {
  public:
    void intersect(RTCScene scene, RTCRayHit& ray) { rtcIntersect1(scene, &ray); }
    /// Intersects the rays of a packet whose `valid` (aligned to 32 bytes) is -1.
    void intersect(RTCScene scene, const int* valid, RTCRayHit8& packet) { rtcIntersect8(valid, scene, &packet); }
    /// Occlusion query: tfar of an occluded ray becomes -infinity.
    void occluded(RTCScene scene, RTCRay& ray) { rtcOccluded1(scene, &ray); }
    /// One ray at a time: Embree 4 has no streams, and packets of shadow rays start as coherent ones whatever the flags
    /// say.
    void occluded(RTCScene scene, std::span<RTCRay> rays) {
        for (RTCRay& ray : rays)
            if (!(ray.tfar < 0.0f)) rtcOccluded1(scene, &ray);
    }
};

inline void set_instance(RTCHit& hit, std::uint32_t instance) {
    hit.instID[0] = instance;
#ifdef RTC_GEOMETRY_INSTANCE_ARRAY  // index within an instance array; there are no instance arrays here
    hit.instPrimID[0] = RTC_INVALID_GEOMETRY_ID;
#endif
}

}  // namespace treefarm
