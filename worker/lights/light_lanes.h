// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "common/guiding/regions/region_model.h"
#include "common/math/elementary.h"
#include "worker/lights/light_bounds.h"

namespace treefarm {

/// A point that light is wanted at.
struct LightReceiver {
    Vec3 p;
    Vec3 front{0.0f};        ///< unit normal of a surface that reflects only, on the side that is looked at
    bool one_sided = false;  ///< whether `front` says what cannot light it
    const LightProbabilities* probabilities = nullptr;  ///< learned there; nullptr: nothing is

    LightReceiver() : p(0.0f) {}
    explicit LightReceiver(const Vec3& point) : p(point) {}
    /// `normal`: nullptr, if light from all around matters.
    LightReceiver(const Vec3& point, const LightProbabilities* learned, const Vec3* normal)
        : p(point), probabilities(learned) {
        if (!normal) return;
        front = *normal;
        one_sided = true;
    }

    const Vec3* normal() const { return one_sided ? &front : nullptr; }
};

/// Whole numbers that probabilities are counted in: what draws, and what says how likely a draw was, agree to the bit.
inline constexpr std::uint32_t kLightWhole = std::uint32_t{1} << 31;
inline constexpr float kLightUnit = 0x1p-31f;
/// By which probabilities are scaled down, so that no rounding makes their sum exceed the whole. What is left over
/// draws nothing: it adds no bias, since densities are the whole numbers.
inline constexpr float kLightMargin = 1.0f - 0x1p-20f;

/// Bounds of up to eight emitters or nodes, side by side, so that what they bring to a point is one loop of vector
/// code. In the tree's own units: the scene's size and the sum of all amounts are about 1.
struct LightLanes {
    static constexpr int kCount = 8;
    using Floats = float[kCount];

    alignas(32) Floats x{}, y{}, z{};  ///< centre
    Floats radius2{};                  ///< squared; negative: at infinity
    Floats axis_x{}, axis_y{}, axis_z{};
    Floats cone_cos{}, cone_sin{};  ///< of its half angle
    Floats falloff_cos{};
    Floats amount{};
    std::uint32_t child[kCount] = {};  ///< node, or kLeaf and an entry

    static constexpr std::uint32_t kLeaf = 0x80000000u;

    void set(int lane, const LightBounds& bounds, const Imath::V3d& origin, double scale, double per_amount);

    /// Estimates of the irradiance at p that each brings: amount times an upper bound of both cosines over the squared
    /// distance. 0 only where nothing arrives. Unlit lanes have 0.
    void estimate(const Vec3& p, const LightReceiver& receiver, Floats& brings) const;
};

/// Sum of a node's estimates, in one order.
inline float sum_of(const LightLanes::Floats& f) {
    return ((f[0] + f[4]) + (f[2] + f[6])) + ((f[1] + f[5]) + (f[3] + f[7]));
}

/// Estimates below this are none: their quotients would leave the range of float.
inline constexpr float kLeastLight = 1e-30f, kMostLight = 1e30f;

inline void LightLanes::estimate(const Vec3& p, const LightReceiver& receiver, Floats& brings) const {
    const Vec3 n = receiver.front;
    const bool one_sided = receiver.one_sided;
    for (int k = 0; k < kCount; ++k) {
        const float vx = x[k] - p.x, vy = y[k] - p.y, vz = z[k] - p.z;
        const float d2 = vx * vx + vy * vy + vz * vz, r2 = radius2[k];
        const bool far = r2 < 0.0f, inside = d2 <= r2;
        const float inverse = 1.0f / std::sqrt(std::max(d2, kLeastNormal));
        const float wx = select(far, axis_x[k], vx * inverse), wy = select(far, axis_y[k], vy * inverse),
                    wz = select(far, axis_z[k], vz * inverse);
        // The half angle that its extent fills as seen from p.
        const float sin2 = std::min(std::max(r2 * inverse * inverse, 0.0f), 1.0f);
        const float wide_sin = select(far, cone_sin[k], std::sqrt(sin2)),
                    wide_cos = select(far, cone_cos[k], std::sqrt(1.0f - sin2));
        const auto nearer = [&](float cosine, float sine) {  // by that half angle
            return select(cosine >= wide_cos, 1.0f, cosine * wide_cos + sine * wide_sin);
        };
        const float at_p = n.x * wx + n.y * wy + n.z * wz;
        const float received = select(one_sided, nearer(at_p, std::sqrt(std::max(1.0f - at_p * at_p, 0.0f))), 1.0f);

        const float off = -(axis_x[k] * wx + axis_y[k] * wy + axis_z[k] * wz);
        const float off_sin = std::sqrt(std::max(1.0f - off * off, 0.0f));
        const bool beyond = off < cone_cos[k];
        const float beyond_cos = select(beyond, off * cone_cos[k] + off_sin * cone_sin[k], 1.0f),
                    beyond_sin = select(beyond, off_sin * cone_cos[k] - off * cone_sin[k], 0.0f);
        const float emission_cos = nearer(beyond_cos, beyond_sin);
        const float emitted = select(far, 1.0f, select(emission_cos > falloff_cos[k], emission_cos, 0.0f));

        const float cosines = select(inside, 1.0f, std::max(emitted, 0.0f) * std::max(received, 0.0f));
        const float distance2 = select(far, 1.0f, std::max(std::max(d2, r2), kLeastNormal));
        const float light = amount[k] * cosines / distance2;
        brings[k] = select(light >= 0.0f, std::min(light, kMostLight), 0.0f);
    }
}

/// Probabilities of a node's lanes, in units of kLightUnit.
struct LightWidths {
    std::int32_t of[LightLanes::kCount];

    /// In proportion to what they bring to p; all 0 where that is nothing.
    LightWidths(const LightLanes& lanes, const Vec3& p, const LightReceiver& receiver) {
        LightLanes::Floats brings;
        lanes.estimate(p, receiver, brings);
        const float total = sum_of(brings);
        const float scale = total > kLeastLight ? static_cast<float>(kLightWhole) * kLightMargin / total : 0.0f;
        for (int k = 0; k < LightLanes::kCount; ++k)
            of[k] = static_cast<std::int32_t>(brings[k] * scale);
    }

    /// The lane that owns 31 random bits; kCount: none does.
    int pick(std::uint32_t bits) const {
        std::uint32_t end = 0;
        int lane = 0;
        for (int k = 0; k < LightLanes::kCount; ++k) {
            end += static_cast<std::uint32_t>(of[k]);
            lane += end <= bits;
        }
        return lane;
    }

    float probability(int lane) const { return static_cast<float>(of[lane]) * kLightUnit; }
};

}  // namespace treefarm
