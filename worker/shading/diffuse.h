#pragma once

#include "common/math/warp.h"

namespace treefarm::diffuse {

/// Lambertian reflection on the side of +z. Directions are unit vectors in the shading frame, both pointing away from
/// the surface: `wo` to where light goes, `wi` to where it comes from.

/// f |cos(wi)|, per steradian.
inline Rgb eval(const Rgb& reflectance, const Vec3& wo, const Vec3& wi) {
    return wo.z > 0.0f && wi.z > 0.0f ? reflectance * (wi.z * kInvPi) : Rgb(0.0f);
}

/// Density of sample() per steradian.
inline float pdf(const Vec3& wo, const Vec3& wi) {
    return wo.z > 0.0f ? cosine_hemisphere_pdf(wi.z) : 0.0f;
}

/// Draws wi in proportion to its cosine; its density is pdf().
inline Vec3 sample(const Vec2& u) {
    return square_to_cosine_hemisphere(u);
}

}  // namespace treefarm::diffuse
