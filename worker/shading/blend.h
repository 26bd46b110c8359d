#pragma once

#include "worker/shading/bsdf_sample.h"

namespace treefarm {

struct Bsdf;

/// (1 - weight) * first + weight * second. What it points to lives as long as the materials, or as the hit whose
/// textures it was looked up in.
struct BlendBsdf {
    float weight = 0.5f;  ///< in [0, 1]
    const Bsdf* first = nullptr;
    const Bsdf* second = nullptr;

    inline BsdfValue value(const Vec3& wo, const Vec3& wi) const;
    inline BsdfSample sample(const Vec3& wo, const BsdfRandom& random) const;
};

}  // namespace treefarm
