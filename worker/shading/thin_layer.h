// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "common/math/exponential.h"
#include "common/math/frame.h"
#include "common/scene/kinds/materials/thin_layer.h"
#include "worker/shading/henyey_greenstein.h"

namespace treefarm {

/// Single scattering in a layer, with the light that passes unscattered (Hanrahan and Krueger 1993, equations 8 and 9;
/// both as Mitsuba 0.6's hk). Directions are sampled from the phase function.
struct ThinLayerBsdf {
    Rgb scattering{0.0f}, depth{0.0f};  ///< optical depths along the normal: of scattering, and of extinction
    HenyeyGreenstein phase;
    bool passes = true;

    LobeBits lobes() const {
        return passes ? kSmoothLobe | kViewLobe | kDeltaLobe | kTransmittingLobe : kSmoothLobe | kViewLobe;
    }
    float refraction() const { return 1.0f; }

    /// Value and density; out of line, as those of dielectrics.
    [[gnu::noinline]] BsdfValue value(const Vec3& wo, const Vec3& wi) const {
        return value(wo, wi, 1.0f - average(straight_on(wo)));
    }

    [[gnu::noinline]] BsdfSample sample(const Vec3& wo, const BsdfRandom& random) const {
        const Rgb through = straight_on(wo);
        const float probability = average(through);
        if (random.lobe < probability) {
            if (!passes) return {};
            return {-wo, probability, through, true};
        }
        const Vec3 wi = phase.sample(wo, random.point);
        const BsdfValue v = value(wo, wi, 1.0f - probability);
        return {wi, v.pdf, v.f_cos, false};
    }

  private:
    /// With a, b = 1/|cos| of the two directions, g(x) = (1 - e^-x)/x, depths s and t: f = s p a b g(t (a + b)) on one
    /// side, s p a b e^(-t min(a, b)) g(t |a - b|) through the layer. Neither divides by a difference. `scattered`: the
    /// probability of sampling the phase function.
    BsdfValue value(const Vec3& wo, const Vec3& wi, float scattered) const {
        const bool reflects = wi.z > 0.0f;
        if (!reflects && !(passes && wi.z < 0.0f)) return {};
        const float a = inverse_cosine(wo), b = inverse_cosine(wi), p = phase.value(wo, wi);
        const float way = reflects ? a + b : std::abs(a - b), unscattered = reflects ? 0.0f : std::min(a, b);
        const auto channel = [&](float s, float t) {
            return s * a * exp_negative(t * unscattered) * mean_transmittance(t * way);
        };
        const Rgb f{channel(scattering.x, depth.x), channel(scattering.y, depth.y), channel(scattering.z, depth.z)};
        return {f * p, scattered * p};
    }

    static float inverse_cosine(const Vec3& w) { return std::min(1.0f / std::abs(w.z), 1e15f); }
    /// (1 - e^-x)/x, the mean of e^-y over [0, x].
    static float mean_transmittance(float x) { return x > 0.0f ? one_minus_exp_negative(x) / x : 1.0f; }

    Rgb straight_on(const Vec3& wo) const {
        const float a = inverse_cosine(wo);
        return {exp_negative(depth.x * a), exp_negative(depth.y * a), exp_negative(depth.z * a)};
    }
};

/// BSDF of the material at one point of a surface (bsdf_builder.h).
template <class Context>
typename Context::Result make_bsdf(const ThinLayerMaterial& m, const Context& at) {
    Rgb scattering = at.amount(m.scattering), depth = at.amount(m.absorption);
    constexpr float kOpaque = 1e15f;  // deeper layers look equal, and products stay finite
    for (int i = 0; i < 3; ++i) {
        const float scattered = std::min(scattering[i], 1e30f), whole = scattered + std::min(depth[i], 1e30f);
        const float shrunk = std::min(1.0f, kOpaque / whole);
        scattering[i] = scattered * shrunk;
        depth[i] = whole * shrunk;
    }
    const float g = std::clamp(at.number(m.mean_cosine), -m.kMostCosine, m.kMostCosine);
    return {ThinLayerBsdf{scattering, depth, {g}, m.passes}};
}

}  // namespace treefarm
