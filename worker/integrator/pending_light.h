#pragma once

#include <array>
#include <cassert>
#include <cstdint>
#include <span>

#include "worker/geometry/embree_scene.h"
#include "worker/integrator/guided_sampling.h"
#include "worker/lights/direct_sample.h"

namespace treefarm {

/// A sampled emitter of which it is not yet known whether it is seen.
struct PendingLight {
    std::uint32_t path;    ///< of the batch
    std::uint32_t vertex;  ///< vertices that the path has recorded before this one
    Guidance guidance;
    Vec3 wi;  ///< as in DirectSample, like distance, pdf and delta
    float distance;
    float pdf;
    bool delta;
    bool from_environment;
    float bsdf_pdf;  ///< of scattering along wi
    Rgb f_cos;
    Rgb radiance;  ///< of the emitter, unless it is the environment
    Rgb throughput;
};

/// Those of one step of a batch of paths.
class PendingLights {
  public:
    static constexpr std::uint32_t kMost = EmbreeScene::kMostTogether;

    void clear() { count_ = 0; }
    bool empty() const { return count_ == 0; }
    std::uint32_t size() const { return count_; }
    PendingLight& operator[](std::size_t i) { return lights_[i]; }

    PendingLight& emplace_back() {
        assert(count_ < kMost);
        return lights_[count_++];
    }

    /// The shadow ray of the last one. Both ends of the segment are moved off their surfaces towards each other.
    void aim(const Hit& hit, const DirectSample& light) {
        Ray& ray = rays_[count_ - 1];
        ray = {offset_origin(hit, light.wi), light.wi};
        if (light.at_infinity()) return;
        ray.direction = offset_origin(light.on_light, -light.wi) - ray.origin;
        // Closer than the offsets: nothing fits between.
        ray.length = dot(ray.direction, light.wi) > 0.0f ? 1.0f : -1.0f;
    }

    /// Which of them are hidden.
    template <class Observer>
    std::span<const bool> trace(const EmbreeScene& geometry, Observer& observer) {
        for (std::uint32_t i = 0; i < count_; ++i)
            observer.shadow(rays_[i]);
        geometry.occluded({rays_.data(), count_}, shadowed_.data());
        return {shadowed_.data(), count_};
    }

  private:
    std::uint32_t count_ = 0;
    std::array<PendingLight, kMost> lights_;
    std::array<Ray, kMost> rays_;
    std::array<bool, kMost> shadowed_;
};

}  // namespace treefarm
