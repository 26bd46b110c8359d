// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/math/warp.h"
#include "common/scene/kinds/materials/diffuse_transmitter.h"
#include "worker/shading/bsdf_sample.h"

namespace treefarm {

/// Lambertian transmission: the other side shines evenly.
struct DiffuseTransmitterBsdf {
    static constexpr LobeBits kLobes = kSmoothLobe | kViewLobe | kTransmittingLobe;

    Rgb transmittance{0.0f};

    float refraction() const { return 1.0f; }

    BsdfValue value(const Vec3& /*wo*/, const Vec3& wi) const {
        if (!(wi.z < 0.0f)) return {};
        return {transmittance * (-wi.z * kInvPi), cosine_hemisphere_pdf(-wi.z)};
    }

    BsdfSample sample(const Vec3& wo, const BsdfRandom& random) const {
        const Vec3 wi(random.cosine.x, random.cosine.y, -random.cosine.z);
        const BsdfValue v = value(wo, wi);
        return {wi, v.pdf, v.f_cos, false};
    }
};

/// The BSDF of such a material at one place of a surface (bsdf_builder.h).
template <class Context>
typename Context::Result make_bsdf(const DiffuseTransmitterMaterial& m, const Context& at) {
    const Rgb transmittance = at.color(m.transmittance);
    if (is_black(transmittance)) return {};
    return {DiffuseTransmitterBsdf{transmittance}};
}

}  // namespace treefarm
