// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/kinds/traits/lobes.h"
#include "common/scene/model/texture.h"

namespace treefarm {

struct DiffuseMaterial {
    ColorInput reflectance{Rgb(0.5f)};  ///< albedo per channel, in [0, 1]

    Lobes lobes() const { return {.diffuse = true}; }
    static void fields(auto& self, auto& visitor) { visitor.fraction("reflectance", self.reflectance); }
};

}  // namespace treefarm
