// SPDX-License-Identifier: Apache-2.0
#include "worker/lights/delta_light.h"

#include <limits>

#include "common/base/error.h"
#include "common/math/elementary.h"

namespace treefarm {

std::optional<DeltaLight> DeltaLight::make(const Emitter& emitter, const TextureSet* textures) {
    DeltaLight light;
    if (const auto* point = std::get_if<PointEmitter>(&emitter.kind)) {
        light.position_ = point->position;
        light.intensity_ = point->intensity;
    } else if (const auto* spot = std::get_if<SpotEmitter>(&emitter.kind)) {
        light.kind_ = Kind::spot;
        light.position_ = spot->position;
        light.axis_ = spot->axis;
        light.intensity_ = spot->intensity;
        light.cutoff_ = spot->cutoff;
        light.beam_ = std::min(spot->beam, spot->cutoff);
        if (spot->texture != kNone) {
            if (!textures) throw RunError("a spot has a texture, but there are no textures");
            light.textures_ = textures;
            light.texture_ = spot->texture;
            const SinCos cutoff = sincos_turn(0.5f * kInvPi * spot->cutoff);
            const float scale = 0.5f * cutoff.cos / cutoff.sin;
            light.u_axis_ = spot->x_axis * scale;
            light.v_axis_ = spot->y_axis * scale;
        }
    } else if (const auto* directional = std::get_if<DirectionalEmitter>(&emitter.kind)) {
        light.kind_ = Kind::directional;
        light.axis_ = directional->direction;
        light.intensity_ = directional->irradiance;
    } else {
        return std::nullopt;
    }
    return light;
}

double DeltaLight::power(double scene_radius) const {
    const double brightness = double(average(intensity_));
    switch (kind_) {
        case Kind::point:
            return 4.0 * double(kPi) * brightness;
        case Kind::spot: {
            // As if it were sharp, halfway down the falloff: 2 pi (1 - cos x) = 4 pi sin^2(x / 2).
            const float sine = sincos_turn(0.25f * kInvPi * 0.5f * (cutoff_ + beam_)).sin;
            return 4.0 * double(kPi) * double(sine) * double(sine) * brightness;
        }
        case Kind::directional:
            return double(kPi) * scene_radius * scene_radius * brightness;
    }
    return 0;
}

DirectSample DeltaLight::sample(const Vec3& p, float selection) const {
    DirectSample sample;
    sample.delta = true;
    if (kind_ == Kind::directional) {
        sample.wi = -axis_;
        sample.distance = std::numeric_limits<float>::infinity();
        sample.pdf = selection;
        sample.radiance = intensity_;
        return sample;
    }
    const Vec3 to_light = position_ - p;
    const float distance2 = dot(to_light, to_light);
    if (!(distance2 > 0.0f)) return sample;
    sample.on_light.p = position_;
    sample.distance = std::sqrt(distance2);
    sample.wi = to_light * (1.0f / sample.distance);
    sample.pdf = selection;
    sample.radiance = intensity_ * (1.0f / distance2);
    if (kind_ == Kind::spot) {
        sample.radiance *= falloff(-sample.wi);
        if (textures_ && !is_black(sample.radiance)) sample.radiance *= projected(-sample.wi);
    }
    return sample;
}

/// Linear in the angle from the axis, which comes from its sine and cosine: a narrow spot's cosines all round to 1.
float DeltaLight::falloff(const Vec3& away) const {
    const Vec3 across = cross(axis_, away);
    const float angle = 2.0f * kPi * azimuth_turn(dot(axis_, away), std::sqrt(dot(across, across)));
    if (angle >= cutoff_) return 0.0f;
    return angle <= beam_ ? 1.0f : (cutoff_ - angle) / (cutoff_ - beam_);
}

/// What the texture has where a direction within the cone meets the plane across the axis.
Rgb DeltaLight::projected(const Vec3& away) const {
    const float inverse = 1.0f / dot(axis_, away);
    return textures_->color(texture_, Vec2(0.5f + dot(u_axis_, away) * inverse, 0.5f + dot(v_axis_, away) * inverse));
}

}  // namespace treefarm
