// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/kinds/materials/diffuse.h"
#include "common/scene/kinds/traits/lobes.h"

namespace treefarm {

/// A sheet whose two sides are alike, and which lets light through evenly in all directions: paper held before a lamp
/// (Mitsuba 0.6's difftrans).
struct DiffuseTransmitterMaterial {
    ColorInput transmittance{Rgb(0.5f)};  ///< the part of the light that passes, per channel, in [0, 1]

    Lobes lobes() const { return {.glossy_transmission = true}; }
    /// Nothing is reflected: what would pass is lost.
    DiffuseMaterial opaque() const { return {Rgb(0.0f)}; }
    static void fields(auto& self, auto& visitor) { visitor.fraction("transmittance", self.transmittance); }
};

}  // namespace treefarm
