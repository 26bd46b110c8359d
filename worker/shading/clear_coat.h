// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/math/elementary.h"
#include "common/math/exponential.h"
#include "common/math/vec.h"

namespace treefarm {

/// Facets of the principled BSDF's clear coat: GTR1 (Burley 2012, appendix B), with the masking of GGX at alpha 0.25.
struct ClearCoat {
    float alpha2 = 0.01f;     ///< square of the roughness, in [1e-6, 0.01]
    float minus_log2 = 4.6f;  ///< -ln(alpha2)

    /// Coat of `gloss` from 0 (alpha 0.1) to 1 (0.001).
    static ClearCoat of(float gloss) {
        const float alpha = 0.1f + gloss * (0.001f - 0.1f);
        return {alpha * alpha, minus_log(alpha * alpha)};
    }

    /// Density per steradian at a unit h. From sine and cosine separately: nothing cancels about the normal.
    float density(const Vec3& h) const {
        const float spread = h.x * h.x + h.y * h.y + alpha2 * h.z * h.z;
        return (1.0f - alpha2) * kInvPi / (minus_log2 * spread);
    }

    /// Samples a facet's normal with density density(h) h.z.
    Vec3 sample(const Vec2& u) const {
        const float e = exp_negative((1.0f - u.y) * minus_log2);
        const float cosine = std::sqrt(std::max(0.0f, (1.0f - e) / (1.0f - alpha2)));
        const float sine = std::sqrt(std::max(0.0f, (e - alpha2) / (1.0f - alpha2)));
        const SinCos phi = sincos_turn(u.x);
        return {sine * phi.cos, sine * phi.sin, cosine};
    }

    static float masking(const Vec3& w) {
        constexpr float kAlpha2 = 0.25f * 0.25f;
        const float sin2 = w.x * w.x + w.y * w.y, cos2 = w.z * w.z;
        return 2.0f * w.z / (w.z + std::sqrt(cos2 + kAlpha2 * sin2));
    }
};

}  // namespace treefarm
