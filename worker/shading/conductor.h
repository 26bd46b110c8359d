// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worker/shading/bsdf_sample.h"
#include "worker/shading/fresnel.h"

namespace treefarm {

/// BSDF of a smooth metal.
struct ConductorBsdf {
    static constexpr LobeBits kLobes = kDeltaLobe;

    Rgb eta{0.0f}, k{1.0f}, reflectance{1.0f};

    BsdfValue value(const Vec3&, const Vec3&) const { return {}; }

    BsdfSample sample(const Vec3& wo, const BsdfRandom&) const {
        return {{-wo.x, -wo.y, wo.z}, 1.0f, reflectance * fresnel_conductor(wo.z, eta, k), true};
    }
};

}  // namespace treefarm
