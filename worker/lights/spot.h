// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "common/base/error.h"
#include "common/math/elementary.h"
#include "common/math/frame.h"
#include "common/scene/kinds/emitters/spot.h"
#include "worker/lights/area_measure.h"
#include "worker/lights/point.h"
#include "worker/lights/sphere_cone.h"

namespace treefarm {

/// Point light that shines in a cone.
class SpotLight {
  public:
    using Kind = SpotEmitter;

    SpotLight(const SpotEmitter& spot, const TextureSet* textures)
        : position_(spot.position),
          axis_(spot.axis),
          intensity_(spot.intensity),
          cutoff_(spot.cutoff),
          beam_(std::min(spot.beam, spot.cutoff)) {
        if (spot.texture == kNone) return;
        if (!textures) throw RunError("a spot has a texture, but there are no textures");
        textures_ = textures;
        texture_ = spot.texture;
        const SinCos cutoff = sincos_turn(0.5f * kInvPi * spot.cutoff);
        const float scale = 0.5f * cutoff.cos / cutoff.sin;
        u_axis_ = spot.x_axis * scale;
        v_axis_ = spot.y_axis * scale;
    }

    /// Power of a spot with a sharp edge halfway down the falloff: 2 pi (1 - cos x) = 4 pi sin^2(x / 2).
    double power(double) const {
        const float sine = sincos_turn(0.25f * kInvPi * 0.5f * (cutoff_ + beam_)).sin;
        const double mean = textures_ ? double(average(mean_color(*textures_, texture_))) : 1.0;
        return 4.0 * double(kPi) * double(sine) * double(sine) * double(average(intensity_)) * mean;
    }

    /// Bounds of the spot. Its linear falloff is below the cosine of these bounds, within a quarter turn.
    LightBounds bounds() const {
        const double mean = textures_ ? double(luminance(mean_color(*textures_, texture_))) : 1.0;
        LightBounds bounds = LightBounds::in_box(Box3(position_, position_), double(luminance(intensity_)) * mean);
        const bool narrow = cutoff_ - beam_ <= 0.5f * kPi;
        bounds.cone = {axis_, (narrow ? beam_ : cutoff_) * kInvPi};
        bounds.falloff = narrow ? (cutoff_ - beam_) * kInvPi : 0.0f;
        return bounds;
    }

    DirectSample sample(const Vec3& p, float selection) const {
        DirectSample sample = sample_point(position_, intensity_, p, selection);
        if (!(sample.pdf > 0.0f)) return sample;
        sample.radiance *= falloff(-sample.wi);
        if (textures_ && !is_black(sample.radiance)) sample.radiance *= projected(-sample.wi);
        return sample;
    }

    /// Ray distributed uniformly in the cone; the falloff is in the weight.
    EmissionSample emit(const SceneBall&, const Draw& random) const {
        const float one_minus_cos = cone();
        const Vec3 local = square_to_cone({to_unit(random[0]), to_unit(random[1])}, one_minus_cos);
        const Vec3 direction = normalize(Frame(axis_).to_world(local));
        Rgb intensity = intensity_ * falloff(direction);
        if (textures_ && !is_black(intensity)) intensity *= projected(direction);
        return emitted_from_point(position_, direction, intensity, cone_pdf(one_minus_cos));
    }
    float direction_pdf(const SceneBall&, const Vec3&) const { return cone_pdf(cone()); }

  private:
    /// 1 - cos of the cutoff.
    float cone() const {
        const float sine = sincos_turn(0.25f * kInvPi * cutoff_).sin;
        return 2.0f * sine * sine;
    }

    /// Falloff linear in the angle from the axis, computed from sine and cosine: a narrow spot's cosines all round to
    /// 1.
    float falloff(const Vec3& away) const {
        const Vec3 across = cross(axis_, away);
        const float angle = 2.0f * kPi * azimuth_turn(dot(axis_, away), std::sqrt(dot(across, across)));
        if (angle >= cutoff_) return 0.0f;
        return angle <= beam_ ? 1.0f : (cutoff_ - angle) / (cutoff_ - beam_);
    }

    /// Texture value at the intersection of a direction within the cone with the plane across the axis.
    Rgb projected(const Vec3& away) const {
        const float inverse = 1.0f / dot(axis_, away);
        return textures_->color(texture_,
                                Vec2(0.5f + dot(u_axis_, away) * inverse, 0.5f + dot(v_axis_, away) * inverse));
    }

    Vec3 position_;
    Vec3 axis_;      ///< unit
    Rgb intensity_;  ///< W / sr, on the axis
    float cutoff_, beam_;
    const TextureSet* textures_ = nullptr;  ///< nullptr: no texture is projected
    std::int32_t texture_ = kNone;
    Vec3 u_axis_{0.0f}, v_axis_{0.0f};  ///< change of u and v per unit along these axes, at distance 1
};

}  // namespace treefarm
