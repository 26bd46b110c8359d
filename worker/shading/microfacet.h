// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/math/vec.h"
#include "common/scene/model/material.h"

namespace treefarm {

/// Distribution of a rough surface's facets with Smith's masking (Walter et al. 2007; Heitz 2014, "Understanding the
/// masking-shadowing function in microfacet-based BRDFs"). Computed without tangents and by sums of positive terms
/// only: nothing cancels at alpha = 1e-4 or at grazing angles.
struct Microfacet {
    bool ggx = true;  ///< otherwise Beckmann's
    float alpha_u = 0.1f, alpha_v = 0.1f;

    /// Smallest roughness in use; below it the surface is a mirror in float precision.
    static constexpr float kMinAlpha = Roughness::kLeastAlpha;
    /// Largest roughness in use; far above any meaning, and its powers are finite.
    static constexpr float kMaxAlpha = 1e6f;

    /// D of the facets whose normal lies along `h` (of any length, h.z > 0), per steradian.
    float density(const Vec3& h) const;

    /// Area of the facets that face `w`, projected on w, per area of surface: cos(w) / G1(w), with w.z >= 0. Never 0
    /// for a unit vector, so that quotients by it are finite at grazing angles.
    float projected_area(const Vec3& w) const;

    /// Smith's G1 = w.z / projected_area(w).
    float masking(const Vec3& w) const { return w.z / projected_area(w); }

    /// Samples a normal visible from `wo` (unit, wo.z > 0) with density density(m) (wo . m) / projected_area(wo) per
    /// steradian. GGX: Heitz 2018, "Sampling the GGX distribution of visible normals"; Beckmann: the slopes of Heitz
    /// and d'Eon 2014, "Importance sampling microfacet-based BSDFs using the distribution of visible normals".
    Vec3 sample_visible(const Vec3& wo, const Vec2& u) const;
};

}  // namespace treefarm
