#pragma once

#include "worker/shading/bsdf_sample.h"

namespace treefarm {

/// Nothing is there, or a boundary without contrast, which can have a colour.
struct NullBsdf {
    Rgb transmittance{1.0f};

    BsdfValue value(const Vec3&, const Vec3&) const { return {}; }
    BsdfSample sample(const Vec3& wo, const BsdfRandom&) const { return {-wo, 1.0f, transmittance, true}; }
};

}  // namespace treefarm
