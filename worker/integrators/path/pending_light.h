// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cassert>
#include <cstdint>
#include <span>

#include "common/guiding/regions/region_sampler.h"
#include "worker/geometry/embree_scene.h"
#include "worker/integrators/record_log.h"
#include "worker/lights/direct_sample.h"
#include "worker/shading/bsdf_sample.h"

namespace treefarm {

/// The vertex that sampled an emitter.
template <class G>
struct LightSeeker {
    std::uint32_t path;    ///< index in the batch
    std::uint32_t vertex;  ///< number of the path's recorded vertices before this one
    float light_samples;   ///< average number of light samples at the vertex
    bool learned_choice;   ///< the emitter was chosen by the region's learned probabilities
    typename G::Guidance guidance;
    Rgb throughput;
};

/// A sampled emitter of unknown visibility.
template <class G>
struct PendingLight {
    LightSeeker<G> from;
    Vec3 wi;  ///< as in DirectSample, like all members up to cluster_probability
    float distance;
    float pdf;
    bool delta;
    bool from_environment;
    std::uint8_t cluster;
    float cluster_probability;
    float bsdf_pdf;  ///< density of scattering along wi
    Rgb f_cos;
    Rgb radiance;  ///< emitted radiance, set later for the environment

    void set(const BsdfValue& bsdf) {
        bsdf_pdf = bsdf.pdf;
        f_cos = bsdf.f_cos;
    }

    /// Record for the choice of emitters, of a sample with the contribution `reflected`.
    Record record(const RegionSampler& guide, float reflected) const {
        const std::uint32_t region = from.guidance.region;
        return light_record(region, guide.quantum_exponent(region), cluster, cluster_probability * from.light_samples,
                            reflected);
    }
};

/// Shadow rays of one step of a batch of paths, with their light samples.
template <class G>
class PendingLights {
  public:
    static constexpr std::uint32_t kMost = EmbreeScene::kMostTogether;

    void clear() { count_ = 0; }
    bool empty() const { return count_ == 0; }
    std::uint32_t size() const { return count_; }
    PendingLight<G>& operator[](std::size_t i) { return lights_[i]; }

    /// Adds a light sample at `hit`; `bsdf`: its BSDF value, if known already.
    [[gnu::always_inline]] void add(const Hit& hit, const DirectSample& light, const LightSeeker<G>& from,
                                    const BsdfValue& bsdf) {
        assert(count_ < kMost);
        PendingLight<G>& pending = lights_[count_];
        pending.from = from;
        pending.wi = light.wi;
        pending.distance = light.distance;
        pending.pdf = light.pdf;
        pending.delta = light.delta;
        pending.from_environment = light.from_environment;
        pending.cluster = light.cluster;
        pending.cluster_probability = light.cluster_probability;
        pending.set(bsdf);
        pending.radiance = light.radiance;
        rays_[count_++] = shadow_ray(hit, light);
    }

    /// Traces the shadow rays. Returns which lights are occluded.
    template <class Observer>
    std::span<const bool> trace(const EmbreeScene& geometry, Observer& observer) {
        for (std::uint32_t i = 0; i < count_; ++i)
            observer.shadow(rays_[i]);
        geometry.occluded({rays_.data(), count_}, shadowed_.data());
        return {shadowed_.data(), count_};
    }

  private:
    std::uint32_t count_ = 0;
    std::array<PendingLight<G>, kMost> lights_;
    std::array<Ray, kMost> rays_;
    std::array<bool, kMost> shadowed_;
};

}  // namespace treefarm
