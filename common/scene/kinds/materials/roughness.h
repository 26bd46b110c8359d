// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/scene/kinds/traits/lobes.h"
#include "common/scene/model/texture.h"

namespace treefarm {

/// How the normals of a rough surface's facets are distributed (Walter et al. 2007; thesis 2.8 to 2.12).
enum class Microfacets : std::uint8_t { smooth, ggx, beckmann };

struct Roughness {
    Microfacets distribution = Microfacets::smooth;
    /// What is smaller is raised to it, with a warning: a mirror to the eye, and its density still a float.
    static constexpr float kLeastAlpha = 1e-4f;

    FloatInput alpha_u{0.1f}, alpha_v{0.1f};  ///< along the tangent and the bitangent, above 0; equal: isotropic

    bool smooth() const { return distribution == Microfacets::smooth; }
    /// Needs tangents.
    bool anisotropic() const { return !smooth() && !(alpha_u == alpha_v); }
    bool operator==(const Roughness&) const = default;

    /// The lobe of what it reflects, and, if the surface lets light through, of what passes.
    Lobes lobes(bool transmits) const {
        Lobes lobes;
        (smooth() ? lobes.delta_reflection : lobes.glossy_reflection) = true;
        if (transmits) (smooth() ? lobes.delta_transmission : lobes.glossy_transmission) = true;
        return lobes;
    }
};

}  // namespace treefarm
