// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "worker/shading/bsdf_sample.h"

namespace treefarm {

struct Bsdf;

/// A BSDF in a frame of its own: about a tilted normal (bump and normal maps), or along the surface's tangents
/// (anisotropy). A direction on different sides of the surface and of the tilted one carries nothing: no light leaks.
struct OrientedBsdf {
    const Bsdf* inner = nullptr;
    Vec3 s{1.0f, 0.0f, 0.0f}, t{0.0f, 1.0f, 0.0f}, n{0.0f, 0.0f, 1.0f};  ///< orthonormal; wo . n > 0
    float shadow_alpha2 = 0.0f;                                          ///< for shadowing(); 0: none

    LobeBits lobes() const;
    float refraction() const;
    Vec3 shading_normal() const;
    inline BsdfValue value(const Vec3& wo, const Vec3& wi) const;
    inline BsdfSample sample(const Vec3& wo, const BsdfRandom& random) const;

    /// Fraction of light along wi that the bumps' own shadows leave (wi.z: cosine with the surface's own normal): the
    /// masking of a GGX surface whose slopes spread like the tilt (Conty Estevez, Lecocq and Stein, "A Microfacet-Based
    /// Shadowing Function to Solve the Bump Terminator Problem", Ray Tracing Gems, 2019).
    float shadowing(const Vec3& wi) const {
        const float cos2 = wi.z * wi.z, sin2 = wi.x * wi.x + wi.y * wi.y;
        return cos2 > 0.0f ? 2.0f / (1.0f + std::sqrt(1.0f + shadow_alpha2 * (sin2 / cos2))) : 0.0f;
    }
    /// alpha^2 of shadowing() for a normal that is tilted to n.
    static float shadow_alpha2_of(const Vec3& n) {
        return std::min(0.125f * (n.x * n.x + n.y * n.y) / std::max(n.z * n.z, 1e-12f), 1.0f);
    }

    Vec3 to_inner(const Vec3& w) const { return {dot(w, s), dot(w, t), dot(w, n)}; }
    Vec3 to_outer(const Vec3& w) const { return s * w.x + t * w.y + n * w.z; }
};

}  // namespace treefarm
