// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <embree4/rtcore.h>

#include <cstdint>
#include <span>

namespace treefarm {

/// Questions about rays in the words of Embree 4: see embree_api.h. Its usual arguments are those of incoherent rays.
class EmbreeRays {
  public:
    void intersect(RTCScene scene, RTCRayHit& ray) { rtcIntersect1(scene, &ray); }
    /// The rays of a packet whose `valid` (aligned to 32 bytes) is -1.
    void intersect(RTCScene scene, const int* valid, RTCRayHit8& packet) { rtcIntersect8(valid, scene, &packet); }
    /// What is hidden gets -infinity as tfar.
    void occluded(RTCScene scene, RTCRay& ray) { rtcOccluded1(scene, &ray); }
    /// One by one: streams are gone, and packets of shadow rays walk together at first, whatever they are told.
    void occluded(RTCScene scene, std::span<RTCRay> rays) {
        for (RTCRay& ray : rays)
            if (!(ray.tfar < 0.0f)) rtcOccluded1(scene, &ray);
    }
};

inline void set_instance(RTCHit& hit, std::uint32_t instance) {
    hit.instID[0] = instance;
#ifdef RTC_GEOMETRY_INSTANCE_ARRAY  // which of an array's instances: there are no arrays here
    hit.instPrimID[0] = RTC_INVALID_GEOMETRY_ID;
#endif
}

}  // namespace treefarm
