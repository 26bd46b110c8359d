// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "worker/geometry/embree_scene.h"
#include "worker/lights/direct_sample.h"

namespace treefarm {

/// Density per steradian from one per area, at a distance and a cosine.
inline float per_steradian(float area_density, float distance2, float cosine) {
    return cosine > 0.0f ? area_density * distance2 / cosine : 0.0f;
}

inline float sphere_area_density(float radius) {
    return kInvFourPi / (radius * radius);
}

/// Completes a sample from the chosen point on the light; `area_density`: the point's density per area.
inline void look_at(DirectSample& sample, const Vec3& p, const Rgb& radiance, float area_density) {
    const Vec3 to_light = sample.on_light.p - p;
    const float distance2 = dot(to_light, to_light);
    if (!(distance2 > 0.0f)) return;
    sample.distance = std::sqrt(distance2);
    sample.wi = to_light * (1.0f / sample.distance);
    const float cosine = -dot(sample.on_light.ng, sample.wi);
    sample.pdf = per_steradian(area_density, distance2, std::abs(cosine));
    if (cosine > 0.0f) sample.radiance = radiance;
}

/// Area of each triangle of a mesh; one value for other shapes.
std::vector<double> part_areas(const EmbreeScene& geometry, std::uint32_t shape);

/// Point of a disk or cylinder, uniform by area.
Hit uniform_point(const EmbreeScene& geometry, std::uint32_t shape, const Vec2& u);

/// Mean colour of a texture over its unit square, as an estimate of an emitter's power: above 0 wherever the texture
/// may be. A mesh attribute is averaged over `shape`.
Rgb mean_color(const TextureSet& textures, std::int32_t texture, const Shape* shape = nullptr);

}  // namespace treefarm
