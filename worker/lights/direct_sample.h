// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worker/geometry/hit.h"
#include "worker/geometry/ray.h"

namespace treefarm {

/// A sampled direction from a point to an emitter.
struct DirectSample {
    Vec3 wi{0.0f};       ///< unit, towards the emitter
    float distance = 0;  ///< infinite for the environment and parallel light
    float pdf = 0;       ///< per steradian, with the probability of the emitter; 0: no sample
    Rgb radiance{0.0f};  ///< leaving the emitter against wi, without occlusion; black on the back
    Hit on_light;        ///< sampled point; undefined at infinity
    /// Whether the emitter has no extent, so that scattering never finds it: pdf is then the probability of its choice,
    /// and radiance the irradiance on a surface that faces it.
    bool delta = false;
    bool from_environment = false;  ///< radiance is set later, by Emitters::environment()

    std::uint8_t cluster = 0;       ///< cluster of the emitter (light_tree.h)
    float cluster_probability = 1;  ///< probability of the emitter within its cluster

    bool at_infinity() const { return std::isinf(distance); }
    bool black() const { return !from_environment && is_black(radiance); }
};

/// Shadow ray from a surface to a sampled emitter. Both ends are offset from their surfaces towards each other.
inline Ray shadow_ray(const Hit& hit, const DirectSample& light) {
    Ray ray{offset_origin(hit, light.wi), light.wi};
    if (light.at_infinity()) return ray;
    ray.direction = offset_origin(light.on_light, -light.wi) - ray.origin;
    // Closer than the offsets: no occluder fits between.
    ray.length = dot(ray.direction, light.wi) > 0.0f ? 1.0f : -1.0f;
    return ray;
}

}  // namespace treefarm
