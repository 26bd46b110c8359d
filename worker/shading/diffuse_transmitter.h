// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/kinds/materials/diffuse_transmitter.h"
#include "worker/shading/diffuse.h"

namespace treefarm {

/// Lambertian transmission, uniform over the other side.
struct DiffuseTransmitterBsdf {
    static constexpr LobeBits kLobes = kSmoothLobe | kViewLobe | kTransmittingLobe;

    Rgb transmittance{0.0f};

    float refraction() const { return 1.0f; }

    BsdfValue value(const Vec3& wo, const Vec3& wi) const { return turned().value(wo, {wi.x, wi.y, -wi.z}); }

    BsdfSample sample(const Vec3& wo, const BsdfRandom& random) const {
        BsdfSample sample = turned().sample(wo, random);
        sample.wi.z = -sample.wi.z;
        return sample;
    }

  private:
    /// Lambertian reflection with the transmittance as its albedo.
    DiffuseBsdf turned() const { return {transmittance}; }
};

/// BSDF of the material at one point of a surface (bsdf_builder.h).
template <class Context>
typename Context::Result make_bsdf(const DiffuseTransmitterMaterial& m, const Context& at) {
    const Rgb transmittance = at.color(m.transmittance);
    if (is_black(transmittance)) return {};
    return {DiffuseTransmitterBsdf{transmittance}};
}

}  // namespace treefarm
