// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/kinds/traits/kind_effect.h"

namespace treefarm {

/// The ways in which a surface sends light on. Glossy: over a range of directions about one; delta: in a single
/// direction.
struct Lobes {
    bool diffuse = false;
    bool glossy_reflection = false, delta_reflection = false;
    bool glossy_transmission = false, delta_transmission = false;  ///< a thin pane's is delta, though straight on
    bool null = false;                                             ///< straight on, as if nothing were there

    Lobes& operator|=(const Lobes& other);
    bool operator==(const Lobes&) const = default;
    bool transmits() const { return glossy_transmission || delta_transmission || null; }
    bool delta() const { return delta_reflection || delta_transmission || null; }
    /// A lobe with a density: what next event can use and a guide can learn from.
    bool smooth() const { return diffuse || glossy_reflection || glossy_transmission; }
    /// A smooth lobe whose directions depend on where light goes.
    bool view_dependent() const { return glossy_reflection || glossy_transmission; }
};

}  // namespace treefarm
