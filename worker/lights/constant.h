// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/random.h"
#include "common/math/warp.h"
#include "common/scene/kinds/emitters/constant.h"
#include "worker/lights/light_bounds.h"
#include "worker/textures/texture_set.h"

namespace treefarm {

/// Environment of equal radiance from all directions, sampled uniformly (contract: environments.h).
class ConstantLight {
  public:
    using Kind = ConstantEmitter;
    struct Sample {
        Vec3 direction;
    };

    void add(const ConstantEmitter& emitter, const TextureSet*) { radiance_ += emitter.radiance; }
    static int part_count() { return 1; }
    double power(int, double from_infinity) const { return from_infinity * double(average(radiance_)); }
    LightBounds bounds(int) const {
        return LightBounds::from_infinity(DirectionCone::all(), double(kPi) * double(luminance(radiance_)));
    }
    void choose(int, float probability) { pdf_ = probability * kInvFourPi; }

    bool shines() const { return !is_black(radiance_); }
    Rgb radiance(const Vec3&) const { return radiance_; }
    static Sample sample(int, const Draw& random) {
        return {square_to_sphere({to_unit(random[2]), to_unit(random[3])})};
    }
    float pdf(const auto&, const auto& probabilities) const {
        return probabilities.by_power() ? pdf_ : probabilities(0) * kInvFourPi;
    }

  private:
    Rgb radiance_{0.0f};  ///< sum over the constant emitters
    float pdf_ = 0;       ///< per steradian, times its probability in the choice by power
};

}  // namespace treefarm
