#pragma once

#include "worker/shading/bsdf_sample.h"
#include "worker/shading/fresnel.h"

namespace treefarm {

/// A smooth boundary between transparent media. Radiance that comes from the far side is scaled by 1/eta^2: rays
/// spread where they leave the denser medium (the convention of Mitsuba 0.6 for radiance).
struct DielectricBsdf {
    float eta = 1.5f;  ///< index of refraction of the far side over that of wo's side
    Rgb reflectance{1.0f}, transmittance{1.0f};

    BsdfValue value(const Vec3&, const Vec3&) const { return {}; }

    /// Out of line, as those of the other dielectrics: what the compiler makes of opaque surfaces does not depend on
    /// it.
    [[gnu::noinline]] BsdfSample sample(const Vec3& wo, const BsdfRandom& random) const {
        const DielectricFresnel f = fresnel_dielectric(wo.z, eta);
        if (random.lobe < f.reflectance)
            return {{-wo.x, -wo.y, wo.z}, f.reflectance, reflectance * f.reflectance, true};
        const float share = 1.0f - f.reflectance, inverse = 1.0f / eta;
        return {{-wo.x * inverse, -wo.y * inverse, -f.cos_transmitted},
                share,
                transmittance * (share * inverse * inverse),
                true};
    }
};

}  // namespace treefarm
