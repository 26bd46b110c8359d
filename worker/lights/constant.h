// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/random.h"
#include "common/math/warp.h"
#include "common/scene/kinds/emitters/constant.h"

namespace treefarm {

/// Radiance that is alike from all directions, sampled uniformly.
struct ConstantLight {
    static constexpr float kPdf = kInvFourPi;  ///< per steradian

    Rgb radiance{0.0f};  ///< of all constant emitters together

    void add(const ConstantEmitter& emitter) { radiance += emitter.radiance; }
    double mean_radiance() const { return double(average(radiance)); }
    Vec3 sample(const Draw& random) const { return square_to_sphere({to_unit(random[2]), to_unit(random[3])}); }
};

}  // namespace treefarm
