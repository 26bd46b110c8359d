// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/scene/emitter.h"
#include "worker/lights/direct_sample.h"
#include "worker/textures/texture_set.h"

namespace treefarm {

/// An emitter without extent: a point, a spot or parallel light. Scattering never finds it; next event always does.
class DeltaLight {
  public:
    /// None for emitters with extent. `textures` must outlive it; RunError if it needs some and there are none.
    static std::optional<DeltaLight> make(const Emitter& emitter, const TextureSet* textures);

    /// Mean of the channels of the power that it sends into a scene of that radius, in watts. The spot's is estimated.
    double power(double scene_radius) const;

    /// What reaches p; pdf is `selection`.
    DirectSample sample(const Vec3& p, float selection) const;

  private:
    enum class Kind : std::uint8_t { point, spot, directional };

    float falloff(const Vec3& away) const;
    Rgb projected(const Vec3& away) const;

    Kind kind_ = Kind::point;
    Vec3 position_{0.0f};
    Vec3 axis_{0.0f};      ///< unit: along which spots and parallel light shine
    Rgb intensity_{0.0f};  ///< W / sr; parallel light: W / m^2
    float cutoff_ = 0, beam_ = 0;
    const TextureSet* textures_ = nullptr;  ///< nullptr: the spot projects none
    std::int32_t texture_ = kNone;
    Vec3 u_axis_{0.0f}, v_axis_{0.0f};  ///< per unit of them, along the axis, u and v change by 1
};

}  // namespace treefarm
