// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worker/geometry/hit.h"
#include "worker/geometry/ray.h"

namespace treefarm {

/// A direction in which an emitter was sampled from a point.
struct DirectSample {
    Vec3 wi{0.0f};       ///< unit, towards the emitter
    float distance = 0;  ///< infinite for the environment and parallel light
    float pdf = 0;       ///< per steradian, choice of the emitter included; 0: no sample
    Rgb radiance{0.0f};  ///< that leaves the emitter against wi, occlusion aside; black on the back
    Hit on_light;        ///< the sampled point; meaningless at infinity
    /// Whether it is of an emitter without extent, which scattering never finds: pdf is then the probability of its
    /// choice, and radiance the irradiance on a surface that faces it.
    bool delta = false;
    bool from_environment = false;  ///< radiance is still to be asked for: Emitters::environment()

    std::uint8_t cluster = 0;       ///< of emitters (light_tree.h)
    float cluster_probability = 1;  ///< with which it was chosen

    bool at_infinity() const { return std::isinf(distance); }
    bool black() const { return !from_environment && is_black(radiance); }
};

/// The ray from a surface to a sampled emitter, whose occlusion hides it. Both ends of the segment are moved off their
/// surfaces towards each other.
inline Ray shadow_ray(const Hit& hit, const DirectSample& light) {
    Ray ray{offset_origin(hit, light.wi), light.wi};
    if (light.at_infinity()) return ray;
    ray.direction = offset_origin(light.on_light, -light.wi) - ray.origin;
    // Closer than the offsets: nothing fits between.
    ray.length = dot(ray.direction, light.wi) > 0.0f ? 1.0f : -1.0f;
    return ray;
}

}  // namespace treefarm
