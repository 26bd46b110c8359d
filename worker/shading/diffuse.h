// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/math/warp.h"
#include "common/scene/kinds/materials/diffuse.h"
#include "worker/shading/bsdf_sample.h"

namespace treefarm {

/// Lambertian reflection.
struct DiffuseBsdf {
    static constexpr LobeBits kLobes = kSmoothLobe | kWideLobe;

    Rgb reflectance{0.0f};

    BsdfValue value(const Vec3& /*wo*/, const Vec3& wi) const {
        if (!(wi.z > 0.0f)) return {};
        return {reflectance * (wi.z * kInvPi), cosine_hemisphere_pdf(wi.z)};
    }

    BsdfSample sample(const Vec3& wo, const BsdfRandom& random) const {
        const Vec3 wi = random.cosine;
        const BsdfValue v = value(wo, wi);
        return {wi, v.pdf, v.f_cos, false};
    }
};

/// BSDF of the material at one point of a surface (bsdf_builder.h).
template <class Context>
typename Context::Result make_bsdf(const DiffuseMaterial& m, const Context& at) {
    const Rgb albedo = at.color(m.reflectance);
    if (is_black(albedo)) return {};
    return {DiffuseBsdf{albedo}};
}

}  // namespace treefarm
