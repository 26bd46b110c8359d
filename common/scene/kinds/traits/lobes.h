// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/kinds/traits/kind_effect.h"

namespace treefarm {

/// Types of scattering of a surface. Glossy: over a range of directions around one; delta: in a single direction.
struct Lobes {
    bool diffuse = false;
    bool glossy_reflection = false, delta_reflection = false;
    bool glossy_transmission = false, delta_transmission = false;  ///< a thin pane's is delta, though straight on
    bool null = false;                                             ///< straight through, as without a surface

    Lobes& operator|=(const Lobes& other);
    bool operator==(const Lobes&) const = default;
    bool transmits() const { return glossy_transmission || delta_transmission || null; }
    bool delta() const { return delta_reflection || delta_transmission || null; }
    /// Whether there is a lobe with a density, which next event can use and a guide can learn.
    bool smooth() const { return diffuse || glossy_reflection || glossy_transmission; }
    /// Whether there is a smooth lobe that depends on the outgoing direction.
    bool view_dependent() const { return glossy_reflection || glossy_transmission; }
};

}  // namespace treefarm
