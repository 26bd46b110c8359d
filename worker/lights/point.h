// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/kinds/emitters/point.h"
#include "worker/lights/direct_sample.h"
#include "worker/lights/emission_sample.h"
#include "worker/lights/light_bounds.h"
#include "worker/textures/texture_set.h"

namespace treefarm {

/// Light at p from a point of this intensity (W / sr); no sample if p is the point itself.
inline DirectSample sample_point(const Vec3& position, const Rgb& intensity, const Vec3& p, float selection) {
    DirectSample sample;
    sample.delta = true;
    const Vec3 to_light = position - p;
    const float distance2 = dot(to_light, to_light);
    if (!(distance2 > 0.0f)) return sample;
    sample.on_light.p = position;
    sample.distance = std::sqrt(distance2);
    sample.wi = to_light * (1.0f / sample.distance);
    sample.pdf = selection;
    sample.radiance = intensity * (1.0f / distance2);
    return sample;
}

/// Point light of equal intensity in all directions.
class PointLight {
  public:
    using Kind = PointEmitter;

    PointLight(const PointEmitter& point, const TextureSet*) : position_(point.position), intensity_(point.intensity) {}

    double power(double) const { return 4.0 * double(kPi) * double(average(intensity_)); }
    LightBounds bounds() const {
        return LightBounds::in_box(Box3(position_, position_), double(luminance(intensity_)));
    }
    DirectSample sample(const Vec3& p, float selection) const {
        return sample_point(position_, intensity_, p, selection);
    }
    EmissionSample emit(const SceneBall&, const Draw& random) const {
        const Vec3 direction = square_to_sphere({to_unit(random[0]), to_unit(random[1])});
        return emitted_from_point(position_, normalize(direction), intensity_, kInvFourPi);
    }
    float direction_pdf(const SceneBall&, const Vec3&) const { return kInvFourPi; }

  private:
    Vec3 position_;
    Rgb intensity_;  ///< W / sr
};

}  // namespace treefarm
