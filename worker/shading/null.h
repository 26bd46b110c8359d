// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/kinds/materials/null.h"
#include "worker/shading/bsdf_sample.h"

namespace treefarm {

/// BSDF of a null boundary, which light passes straight on, with a colour.
struct NullBsdf {
    static constexpr LobeBits kLobes = kDeltaLobe;

    Rgb transmittance{1.0f};

    BsdfValue value(const Vec3&, const Vec3&) const { return {}; }
    BsdfSample sample(const Vec3& wo, const BsdfRandom&) const { return {-wo, 1.0f, transmittance, true}; }
};

/// BSDF of the material at one point of a surface (bsdf_builder.h).
template <class Context>
typename Context::Result make_bsdf(const NullMaterial&, const Context&) {
    return {NullBsdf{}};
}

}  // namespace treefarm
