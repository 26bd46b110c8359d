// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/kinds/materials/thin_dielectric.h"
#include "worker/shading/bsdf_sample.h"
#include "worker/shading/dielectric.h"

namespace treefarm {

/// BSDF of a thin pane: R + T R T + T R^3 T + ... is reflected, the rest passes straight on.
struct ThinDielectricBsdf {
    static constexpr LobeBits kLobes = kDeltaLobe | kTransmittingLobe;

    float eta = 1.5f;  ///< index of refraction of the pane over that of its surroundings
    Rgb reflectance{1.0f}, transmittance{1.0f};

    float refraction() const { return 1.0f; }

    BsdfValue value(const Vec3&, const Vec3&) const { return {}; }

    [[gnu::noinline]] BsdfSample sample(const Vec3& wo, const BsdfRandom& random) const {
        const float once = fresnel_dielectric(wo.z, eta).reflectance;
        const float r = 2.0f * once / (1.0f + once);  // the series summed up
        const float mirror = mirror_probability(r, reflectance, transmittance);
        if (random.lobe < mirror) return {{-wo.x, -wo.y, wo.z}, mirror, reflectance * r, true};
        return {-wo, 1.0f - mirror, transmittance * (1.0f - r), true};
    }
};

/// BSDF of the material at one point of a surface (bsdf_builder.h).
template <class Context>
typename Context::Result make_bsdf(const ThinDielectricMaterial& m, const Context& at) {
    return {ThinDielectricBsdf{m.eta, at.color(m.specular_reflectance), at.color(m.specular_transmittance)}};
}

}  // namespace treefarm
