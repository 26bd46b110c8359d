// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worker/shading/bsdf_sample.h"
#include "worker/shading/fresnel.h"

namespace treefarm {

/// Probability of sampling the reflection of smooth glass: in proportion to the light of each way, so that no path is
/// lost on a way that is black.
inline float mirror_probability(float mirrored, const Rgb& reflectance, const Rgb& transmittance) {
    const float one = mirrored * average(reflectance), other = (1.0f - mirrored) * average(transmittance);
    return one + other > 0.0f ? one / (one + other) : mirrored;
}

/// BSDF of a smooth boundary between transparent media. Radiance from the far side is scaled by 1/eta^2: rays spread
/// when they leave the denser medium (the convention of Mitsuba 0.6 for radiance).
struct DielectricBsdf {
    static constexpr LobeBits kLobes = kDeltaLobe | kTransmittingLobe;

    float eta = 1.5f;  ///< index of refraction of the far side over that of wo's side
    Rgb reflectance{1.0f}, transmittance{1.0f};

    float refraction() const { return eta; }

    BsdfValue value(const Vec3&, const Vec3&) const { return {}; }

    /// Sample of a direction; out of line, as in the other dielectrics, so that the code for opaque surfaces does not
    /// depend on it.
    [[gnu::noinline]] BsdfSample sample(const Vec3& wo, const BsdfRandom& random) const {
        const DielectricFresnel f = fresnel_dielectric(wo.z, eta);
        const float mirror = mirror_probability(f.reflectance, reflectance, transmittance);
        if (random.lobe < mirror) return {{-wo.x, -wo.y, wo.z}, mirror, reflectance * f.reflectance, true};
        const float fraction = 1.0f - f.reflectance, inverse = 1.0f / eta;
        return {{-wo.x * inverse, -wo.y * inverse, -f.cos_transmitted},
                1.0f - mirror,
                transmittance * (fraction * inverse * inverse),
                true};
    }
};

}  // namespace treefarm
