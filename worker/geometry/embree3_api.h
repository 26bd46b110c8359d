// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <embree3/rtcore.h>

#include <cstdint>
#include <span>

namespace treefarm {

/// Ray queries with Embree 3: see embree_api.h.
class EmbreeRays {
  public:
    EmbreeRays() {
        rtcInitIntersectContext(&context_);
        context_.flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    }

    void intersect(RTCScene scene, RTCRayHit& ray) { rtcIntersect1(scene, &context_, &ray); }
    /// Intersects the rays of a packet whose `valid` (aligned to 32 bytes) is -1.
    void intersect(RTCScene scene, const int* valid, RTCRayHit8& packet) {
        rtcIntersect8(valid, scene, &context_, &packet);
    }
    /// Occlusion query: tfar of an occluded ray becomes -infinity.
    void occluded(RTCScene scene, RTCRay& ray) { rtcOccluded1(scene, &context_, &ray); }
    void occluded(RTCScene scene, std::span<RTCRay> rays) {
        rtcOccluded1M(scene, &context_, rays.data(), static_cast<unsigned>(rays.size()), sizeof(RTCRay));
    }

  private:
    RTCIntersectContext context_;
};

inline void set_instance(RTCHit& hit, std::uint32_t instance) {
    hit.instID[0] = instance;
}

}  // namespace treefarm
