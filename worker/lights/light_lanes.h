// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "common/guiding/regions/region_model.h"
#include "common/math/elementary.h"
#include "worker/lights/light_bounds.h"

namespace treefarm {

/// A point that receives light.
struct LightReceiver {
    Vec3 p;
    Vec3 front{0.0f};        ///< unit normal of a surface that only reflects, on the side of wo
    bool one_sided = false;  ///< whether light from behind `front` is excluded
    const LightProbabilities* probabilities = nullptr;  ///< learned probabilities at the point; nullptr: none
    /// Probabilities computed by the choice at this point (FlatLights); nullptr: they must be computed again.
    const std::int32_t* widths = nullptr;

    LightReceiver() : p(0.0f) {}
    explicit LightReceiver(const Vec3& point) : p(point) {}
    /// `normal`: nullptr if light from all directions counts.
    LightReceiver(const Vec3& point, const LightProbabilities* learned, const Vec3* normal)
        : p(point), probabilities(learned) {
        if (!normal) return;
        front = *normal;
        one_sided = true;
    }

    const Vec3* normal() const { return one_sided ? &front : nullptr; }
};

/// Storage that LightReceiver::widths points to.
using LightWidthStore = std::array<std::int32_t, kLightClusters>;

/// Integer unit of probabilities: choice and density use the same integers and agree to the bit.
inline constexpr std::uint32_t kLightWhole = std::uint32_t{1} << 31;
inline constexpr float kLightUnit = 0x1p-31f;
/// Scale of probabilities, below 1 so that rounding does not make their sum exceed the whole. The remainder chooses no
/// emitter, which adds no bias, since densities are the same integers.
inline constexpr float kLightMargin = 1.0f - 0x1p-20f;

/// Bounds of one emitter or node, one lane of LightLanes.
struct LightLane {
    float x, y, z, radius2, axis_x, axis_y, axis_z, cone_cos, cone_sin, falloff_cos, amount;
};

/// Bounds of up to eight emitters or nodes, as a structure of arrays: estimating their contributions to a point is one
/// loop of vector code. In LightSpace: the scene's size and the sum of all amounts are about 1.
struct LightLanes {
    static constexpr int kCount = 8;
    using Floats = float[kCount];

    alignas(32) Floats x{}, y{}, z{};  ///< centre
    Floats radius2{};                  ///< squared; negative: at infinity
    Floats axis_x{}, axis_y{}, axis_z{};
    Floats cone_cos{}, cone_sin{};  ///< of the cone's half angle
    Floats falloff_cos{};
    Floats amount{};
    std::uint32_t child[kCount] = {};  ///< a node, or kLeaf with an entry

    static constexpr std::uint32_t kLeaf = 0x80000000u;

    LightLane operator[](int k) const {
        return {x[k],      y[k],        z[k],        radius2[k],     axis_x[k], axis_y[k],
                axis_z[k], cone_cos[k], cone_sin[k], falloff_cos[k], amount[k]};
    }

    void set(int lane, const LightBounds& bounds, const Imath::V3d& origin, double scale, double per_amount);

    /// Estimates of each lane's irradiance at p: amount times an upper bound of both cosines over the squared distance.
    /// 0 only if nothing arrives, and in unused lanes.
    void estimate(const Vec3& p, const LightReceiver& receiver, Floats& brings) const;
};

/// Sum of a node's estimates, in a fixed order.
inline float sum_of(const LightLanes::Floats& f) {
    return ((f[0] + f[4]) + (f[2] + f[6])) + ((f[1] + f[5]) + (f[3] + f[7]));
}

/// Range of usable estimates: smaller ones count as 0, since their quotients would leave the range of float.
inline constexpr float kLeastLight = 1e-29f, kMostLight = 1e30f;

/// Estimate of one emitter's contribution to p: see LightLanes::estimate(). Arguments by value, so that the compiler
/// vectorises it over emitters as well as over points, with equal bits.
[[gnu::always_inline]] inline float light_estimate(const LightLane l, float px, float py, float pz, float nx, float ny,
                                                   float nz, bool one_sided) {
    const float vx = l.x - px, vy = l.y - py, vz = l.z - pz;
    const float d2 = vx * vx + vy * vy + vz * vz, r2 = l.radius2;
    const bool far = r2 < 0.0f, inside = d2 <= r2;
    const float inverse = 1.0f / std::sqrt(std::max(d2, kLeastNormal));
    const float wx = select(far, l.axis_x, vx * inverse), wy = select(far, l.axis_y, vy * inverse),
                wz = select(far, l.axis_z, vz * inverse);
    // Half angle subtended by the bounds as seen from p.
    const float sin2 = std::min(std::max(r2 * inverse * inverse, 0.0f), 1.0f);
    const float wide_sin = select(far, l.cone_sin, std::sqrt(sin2)),
                wide_cos = select(far, l.cone_cos, std::sqrt(1.0f - sin2));
    const auto nearer = [&](float cosine, float sine) {  // an angle reduced by that half angle
        return select(cosine >= wide_cos, 1.0f, cosine * wide_cos + sine * wide_sin);
    };
    const float at_p = nx * wx + ny * wy + nz * wz;
    const float received = select(one_sided, nearer(at_p, std::sqrt(std::max(1.0f - at_p * at_p, 0.0f))), 1.0f);

    const float off = -(l.axis_x * wx + l.axis_y * wy + l.axis_z * wz);
    const float off_sin = std::sqrt(std::max(1.0f - off * off, 0.0f));
    const bool beyond = off < l.cone_cos;
    const float beyond_cos = select(beyond, off * l.cone_cos + off_sin * l.cone_sin, 1.0f),
                beyond_sin = select(beyond, off_sin * l.cone_cos - off * l.cone_sin, 0.0f);
    const float emission_cos = nearer(beyond_cos, beyond_sin);
    const float emitted = select(far, 1.0f, select(emission_cos > l.falloff_cos, emission_cos, 0.0f));

    const float cosines = select(inside, 1.0f, std::max(emitted, 0.0f) * std::max(received, 0.0f));
    const float distance2 = select(far, 1.0f, std::max(std::max(d2, r2), kLeastNormal));
    const float light = l.amount * cosines / distance2;
    return select(light >= 0.0f, std::min(light, kMostLight), 0.0f);
}

[[gnu::always_inline]] inline void LightLanes::estimate(const Vec3& p, const LightReceiver& receiver,
                                                        Floats& brings) const {
    const Vec3 n = receiver.front;
    for (int k = 0; k < kCount; ++k)
        brings[k] = light_estimate((*this)[k], p.x, p.y, p.z, n.x, n.y, n.z, receiver.one_sided);
}

/// Probabilities of a node's lanes, in units of kLightUnit.
struct LightWidths {
    std::int32_t of[LightLanes::kCount];

    /// In proportion to the estimates at p; all 0 if their sum is.
    LightWidths(const LightLanes& lanes, const Vec3& p, const LightReceiver& receiver) {
        LightLanes::Floats brings;
        lanes.estimate(p, receiver, brings);
        const float total = sum_of(brings);
        const float scale = total > kLeastLight ? static_cast<float>(kLightWhole) * kLightMargin / total : 0.0f;
        for (int k = 0; k < LightLanes::kCount; ++k)
            of[k] = static_cast<std::int32_t>(brings[k] * scale);
    }

    /// Lane whose interval contains 31 random bits; kCount: none.
    int pick(std::uint32_t bits) const {
        std::uint32_t end = 0;
        int lane = 0;
        for (const auto part : of) {
            end += static_cast<std::uint32_t>(part);
            lane += end <= bits;
        }
        return lane;
    }

    float probability(int lane) const { return static_cast<float>(of[lane]) * kLightUnit; }
};

}  // namespace treefarm
