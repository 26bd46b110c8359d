// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/kinds/materials/diffuse.h"
#include "common/scene/kinds/traits/lobes.h"

namespace treefarm {

/// A sheet with two equal sides that transmits light evenly in all directions, like paper in front of a lamp (Mitsuba
/// 0.6's difftrans).
struct DiffuseTransmitterMaterial {
    ColorInput transmittance{Rgb(0.5f)};  ///< transmitted part of the light, per channel, in [0, 1]

    Lobes lobes() const { return {.glossy_transmission = true}; }
    /// Opaque form: nothing is reflected, since only transmission exists.
    DiffuseMaterial opaque() const { return {Rgb(0.0f)}; }
    static void fields(auto& self, auto& visitor) { visitor.fraction("transmittance", self.transmittance); }
};

}  // namespace treefarm
