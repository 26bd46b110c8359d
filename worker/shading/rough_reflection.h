// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worker/shading/bsdf_sample.h"
#include "worker/shading/microfacet.h"

namespace treefarm {

/// Mirror reflection by facets of reflectance 1: the common part of rough metals, glass and plastic.
struct RoughReflection {
    float f_cos;  ///< f cos(wi) without Fresnel's term, per steradian
    float pdf;    ///< of reflected(wo, visible normal), per steradian
    float cos_o;  ///< of wo (and wi) with the facet's normal, in [0, 1]
};

/// Requires wo.z > 0 and wi.z > 0. G1(wo) / cos(wo) is 1 / projected_area(wo): no division by a cosine.
[[gnu::always_inline]] inline RoughReflection rough_reflection(const Microfacet& facets, const Vec3& wo,
                                                               const Vec3& wi) {
    const Vec3 h = wo + wi;
    const float pdf = facets.density(h) / (4.0f * facets.projected_area(wo));
    // wo . h / |h| of unit vectors, without the cancellation of 1 + wo . wi.
    return {pdf * facets.masking(wi), pdf, std::min(1.0f, 0.5f * std::sqrt(dot(h, h)))};
}

inline Vec3 reflected(const Vec3& wo, const Vec3& m) {
    return m * (2.0f * dot(wo, m)) - wo;
}

}  // namespace treefarm
