// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <variant>

#include "common/scene/texture.h"

namespace treefarm {

/// Emits `radiance` from the front of a shape, in every direction of the hemisphere.
struct AreaEmitter {
    ColorInput radiance{Rgb(1.0f)};  ///< W / (m^2 sr), per channel
    std::int32_t shape = kNone;
};

struct PointEmitter {
    Vec3 position{0.0f};
    Rgb intensity{1.0f};  ///< W / sr
};

/// A point that shines along `axis`: fully within `beam` of it, not at all beyond `cutoff`, and in between linearly in
/// the angle. A texture is projected like a slide: its unit square fills the square about the circle in which the cone
/// of `cutoff` cuts a plane across the axis.
struct SpotEmitter {
    Vec3 position{0.0f};
    Vec3 axis{0.0f, 0.0f, 1.0f};   ///< unit, away from the emitter
    Rgb intensity{1.0f};           ///< W / sr, on the axis
    float cutoff = 0.3490659f;     ///< radians, above 0, at most pi
    float beam = 0.2617994f;       ///< radians, 0 to cutoff
    std::int32_t texture = kNone;  ///< factor on the intensity; then cutoff is below pi / 2
    /// Unit, at right angles to `axis` and each other: along which u and v of the texture rise.
    Vec3 x_axis{1.0f, 0.0f, 0.0f}, y_axis{0.0f, 1.0f, 0.0f};
};

/// Parallel light.
struct DirectionalEmitter {
    Vec3 direction{0.0f, 0.0f, 1.0f};  ///< unit, along which the light travels
    Rgb irradiance{1.0f};              ///< W / m^2 on a surface that faces it
};

/// Emits `radiance` from infinity, in every direction.
struct ConstantEmitter {
    Rgb radiance{1.0f};
};

/// A distant sphere of radiance. The direction d, turned into its frame as (d . x_axis, d . y_axis, d . z_axis), lies
/// at u = atan2(x, -z) / (2 pi) and v = acos(y) / pi of the image: v runs down from the pole y, u repeats.
struct EnvironmentEmitter {
    std::int32_t image = kNone;  ///< index in Scene::images; three linear channels
    float scale = 1.0f;
    Vec3 x_axis{1.0f, 0.0f, 0.0f}, y_axis{0.0f, 1.0f, 0.0f}, z_axis{0.0f, 0.0f, 1.0f};  ///< unit, at right angles
    /// The centres of the first and the last row of pixels lie on the poles (Mitsuba 2 and 3), not their edges (0.6).
    bool rows_at_poles = false;
};

struct Emitter {
    std::variant<AreaEmitter, PointEmitter, SpotEmitter, DirectionalEmitter, ConstantEmitter, EnvironmentEmitter> kind;
    Location where;
};

}  // namespace treefarm
