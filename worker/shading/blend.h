// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/kinds/materials/blend.h"
#include "worker/shading/bsdf_sample.h"

namespace treefarm {

struct Bsdf;

/// Blend (1 - weight) * first + weight * second. The parts live as long as the materials, or as the hit whose textures
/// were looked up.
struct BlendBsdf {
    float weight = 0.5f;  ///< in [0, 1]
    const Bsdf* first = nullptr;
    const Bsdf* second = nullptr;

    LobeBits lobes() const;
    float refraction() const;
    Vec3 shading_normal() const;
    inline BsdfValue value(const Vec3& wo, const Vec3& wi) const;
    inline BsdfSample sample(const Vec3& wo, const BsdfRandom& random) const;
};

/// BSDF of the material at one point of a surface (bsdf_builder.h).
template <class Context>
typename Context::Result make_bsdf(const BlendMaterial& m, const Context& at) {
    const float weight = at.fraction(m.weight);
    return {BlendBsdf{weight, at.part(m.first), at.part(m.second)}};
}

}  // namespace treefarm
