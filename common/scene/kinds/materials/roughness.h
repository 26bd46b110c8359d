// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/scene/kinds/traits/inputs.h"
#include "common/scene/kinds/traits/lobes.h"

namespace treefarm {

/// Distribution of the normals of a rough surface's facets (Walter et al. 2007; thesis 2.8 to 2.12).
enum class Microfacets : std::uint8_t { smooth, ggx, beckmann };

struct Roughness {
    Microfacets distribution = Microfacets::smooth;
    /// Least alpha; smaller values are raised to it, with a warning: it looks like a mirror, and its density is still a
    /// float.
    static constexpr float kLeastAlpha = 1e-4f;

    FloatInput alpha_u{0.1f}, alpha_v{0.1f};  ///< along the tangent and the bitangent, above 0; equal: isotropic

    bool smooth() const { return distribution == Microfacets::smooth; }
    /// Whether tangents are needed.
    bool anisotropic() const { return !smooth() && !(alpha_u == alpha_v); }
    bool operator==(const Roughness&) const = default;

    /// Lobe of the reflection, and, if the surface transmits light, of the transmission.
    Lobes lobes(bool transmits) const {
        Lobes lobes;
        (smooth() ? lobes.delta_reflection : lobes.glossy_reflection) = true;
        if (transmits) (smooth() ? lobes.delta_transmission : lobes.glossy_transmission) = true;
        return lobes;
    }
};

}  // namespace treefarm
