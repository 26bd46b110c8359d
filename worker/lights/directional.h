// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "common/scene/kinds/emitters/directional.h"
#include "worker/lights/direct_sample.h"
#include "worker/lights/emission_sample.h"
#include "worker/lights/light_bounds.h"
#include "worker/textures/texture_set.h"

namespace treefarm {

/// Parallel light.
class DirectionalLight {
  public:
    using Kind = DirectionalEmitter;

    DirectionalLight(const DirectionalEmitter& parallel, const TextureSet*)
        : direction_(parallel.direction), irradiance_(parallel.irradiance) {}

    double power(double scene_radius) const {
        return double(kPi) * scene_radius * scene_radius * double(average(irradiance_));
    }
    LightBounds bounds() const {
        return LightBounds::from_infinity({-direction_, 0.0f}, double(luminance(irradiance_)));
    }
    DirectSample sample(const Vec3&, float selection) const {
        DirectSample sample;
        sample.delta = true;
        sample.wi = -direction_;
        sample.distance = std::numeric_limits<float>::infinity();
        sample.pdf = selection;
        sample.radiance = irradiance_;
        return sample;
    }
    EmissionSample emit(const SceneBall& ball, const Draw& random) const {
        return emitted_across(ball, direction_, irradiance_, {to_unit(random[0]), to_unit(random[1])},
                              EmissionFrom::parallel);
    }
    float direction_pdf(const SceneBall& ball, const Vec3&) const { return 1.0f / ball.section(); }

  private:
    Vec3 direction_;  ///< unit, in which the light travels
    Rgb irradiance_;  ///< W / m^2
};

}  // namespace treefarm
