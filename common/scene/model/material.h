// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/error.h"
#include "common/scene/kinds/materials.h"
#include "common/scene/kinds/traits/inputs.h"

namespace treefarm {

/// A surface whose shading normal is tilted.
struct NormalDetail {
    std::int32_t bump = kNone;  ///< texture of displacements along the normal, in scene units
    float bump_scale = 1.0f;
    std::int32_t normal_map = kNone;  ///< texture that, times normal_scale, stores normals as (n + 1) / 2, in the
                                      ///< tangent frame
    Rgb normal_scale{1.0f};
    /// A tilted normal that faces away from where the surface is seen from is turned by half a turn about the surface's
    /// own (Schuessler et al. 2017), as Mitsuba does since 3.7.1. Otherwise it is bent until it faces there.
    bool flip_invalid = false;
    /// Light that comes in at a grazing angle is dimmed towards the tilted terminator (Conty Estevez et al. 2019), as
    /// Mitsuba does since 3.7.1.
    bool shadowed = false;
    bool operator==(const NormalDetail&) const = default;
    bool any() const { return bump != kNone || normal_map != kNone; }
};

/// How a surface scatters.
///
/// The front is where the shading normal points. Opaque materials are black on their back unless `twosided`; those that
/// transmit (dielectric, thin dielectric, null, and blends with them) have both sides by nature and are never twosided.
struct Material {
    MaterialKind bsdf;
    bool twosided = false;      ///< the back scatters like the front, mirrored, or as `back` says
    std::int32_t back = kNone;  ///< twosided only: index of the material of the back, below this material's own
    /// Factors that textures take above 1 stay so (Mitsuba 2 and 3); otherwise they are scaled down (0.6).
    bool unlimited = false;
    FloatInput opacity{1.0f};  ///< probability that a ray meets the surface at all, in [0, 1]; of the shape's material
    NormalDetail detail;
    std::string name;
    Location where;

    /// Whether factors that textures take above 1 stay so: not in kinds that would send back light without end.
    bool keeps_factors() const {
        const auto needs_limit = [](const auto& kind) {
            if constexpr (requires { kind.needs_limit(); })
                return kind.needs_limit();
            else
                return false;
        };
        return unlimited && !std::visit(needs_limit, bsdf);
    }

    bool masked() const { return opacity.varies() || opacity.value < 1.0f; }
};

}  // namespace treefarm
