// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/error.h"
#include "common/math/elementary.h"
#include "common/scene/kinds/emitters/projector.h"
#include "worker/lights/area_measure.h"
#include "worker/lights/point.h"

namespace treefarm {

/// Point light that projects an image. With irradiance E on the plane at distance 1 its intensity at the angle t from
/// the axis is E / cos^3 t: the distance is 1 / cos t, and the plane is tilted by t.
class ProjectorLight {
  public:
    using Kind = ProjectorEmitter;

    ProjectorLight(const ProjectorEmitter& projector, const TextureSet* textures)
        : position_(projector.position),
          axis_(projector.axis),
          u_axis_(projector.x_axis * (0.5f / projector.half_width)),
          v_axis_(projector.y_axis * (0.5f / projector.half_height)),
          irradiance_(projector.irradiance.value),
          textures_(textures),
          texture_(projector.irradiance.texture),
          area_(4.0 * double(projector.half_width) * double(projector.half_height)) {
        if (texture_ != kNone && !textures) throw RunError("a projector has a texture, but there are no textures");
    }

    double power(double) const {
        const double mean = texture_ != kNone ? double(average(mean_color(*textures_, texture_))) : 1.0;
        return area_ * double(average(irradiance_)) * mean;
    }

    /// Bounds of the projected light, which is brightest at the image's corners.
    LightBounds bounds() const {
        const double mean = texture_ != kNone ? double(luminance(mean_color(*textures_, texture_))) : 1.0;
        const double u = 0.25 / double(dot(u_axis_, u_axis_)), v = 0.25 / double(dot(v_axis_, v_axis_));
        const double to_corner = std::sqrt(1.0 + u + v);
        LightBounds bounds = LightBounds::in_box(
            Box3(position_, position_), double(luminance(irradiance_)) * mean * to_corner * to_corner * to_corner);
        bounds.cone = {axis_, 2.0f * azimuth_turn(1.0f, static_cast<float>(std::sqrt(u + v)))};
        bounds.falloff = 0.0f;
        return bounds;
    }

    DirectSample sample(const Vec3& p, float selection) const {
        DirectSample sample = sample_point(position_, irradiance_, p, selection);
        if (!(sample.pdf > 0.0f)) return sample;
        const Vec3 away = -sample.wi;
        const float cosine = dot(axis_, away), u = dot(u_axis_, away), v = dot(v_axis_, away);
        if (!(cosine > 0.0f && std::abs(u) <= 0.5f * cosine && std::abs(v) <= 0.5f * cosine)) {
            sample.radiance = Rgb(0.0f);
            return sample;
        }
        const float inverse = 1.0f / cosine;
        sample.radiance *= inverse * inverse * inverse;
        if (texture_ != kNone)
            sample.radiance *= textures_->color(texture_, Vec2(0.5f + u * inverse, 0.5f + v * inverse));
        return sample;
    }

    /// Ray to a uniform point of the image.
    EmissionSample emit(const SceneBall&, const Draw& random) const {
        const float u = to_unit(random[0]), v = to_unit(random[1]);
        const Vec3 to =
            axis_ + u_axis_ * ((u - 0.5f) / dot(u_axis_, u_axis_)) + v_axis_ * ((v - 0.5f) / dot(v_axis_, v_axis_));
        const float length2 = dot(to, to), length = std::sqrt(length2), cos3 = 1.0f / (length * length2);
        Rgb intensity = irradiance_ * (1.0f / cos3);
        if (texture_ != kNone) intensity *= textures_->color(texture_, Vec2(u, v));
        return emitted_from_point(position_, to * (1.0f / length), intensity,
                                  1.0f / (static_cast<float>(area_) * cos3));
    }
    float direction_pdf(const SceneBall&, const Vec3& away) const {
        const float cosine = dot(axis_, away);
        return 1.0f / (static_cast<float>(area_) * (cosine * cosine * cosine));
    }

  private:
    Vec3 position_;
    Vec3 axis_;             ///< unit
    Vec3 u_axis_, v_axis_;  ///< change of u and v per unit along these axes, at distance 1
    Rgb irradiance_;        ///< W / m^2 on the plane at distance 1, or the factor on the texture
    const TextureSet* textures_;
    std::int32_t texture_;
    double area_;  ///< area of the image on that plane
};

}  // namespace treefarm
