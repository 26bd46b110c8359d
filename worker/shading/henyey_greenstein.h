// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "common/math/elementary.h"
#include "common/math/frame.h"
#include "worker/shading/bsdf_sample.h"

namespace treefarm {

/// Henyey-Greenstein phase function (1941), for directions that point away from the scattering point.
struct HenyeyGreenstein {
    float g = 0.0f;  ///< mean cosine between the way in and the way out, |g| at most 0.99

    /// Value and density per steradian. 1 + g^2 + 2 g cos is summed from parts without cancellation.
    float value(const Vec3& wo, const Vec3& wi) const {
        const float forward = 1.0f - std::abs(g);
        const Vec3 apart = g > 0.0f ? wo + wi : wo - wi;
        const float d = forward * forward + std::abs(g) * dot(apart, apart);
        return 0.25f * kInvPi * forward * (1.0f + std::abs(g)) / (d * std::sqrt(d));
    }

    /// Samples wi by the density, on either side.
    Vec3 sample(const Vec3& wo, const Vec2& u) const {
        // 1 - cos of the angle to the forward direction, or to the backward one if g is negative; at most 2 but for
        // rounding.
        const float h = std::abs(g), ratio = (1.0f - h) / (1.0f - h + 2.0f * h * u.x);
        const float away = std::min(2.0f, 2.0f * ratio * ratio * (1.0f - u.x) * (1.0f + h * u.x));
        const float cos = 1.0f - away, sin = std::sqrt(std::max(0.0f, away * (2.0f - away)));
        const SinCos turn = sincos_turn(u.y);
        return Frame(g > 0.0f ? -wo : wo).to_world({sin * turn.cos, sin * turn.sin, cos});
    }
};

}  // namespace treefarm
