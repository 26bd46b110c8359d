// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/kinds/traits/texture_traits.h"

namespace treefarm {

/// Squares of half a unit: color0 where u and v are both in the lower or both in the upper half of their unit.
struct CheckerboardTexture {
    Rgb color0{0.4f}, color1{0.2f};
    UvTransform uv;

    static constexpr KindEffect kEffect{"checkerboards", "checkerboard"};
    ValueRange range(const auto&) const { return range_of_colors(color0, color1); }
    Rgb mean(const auto&) const { return (color0 + color1) * 0.5f; }
    static void fields(auto& self, auto& visitor) {
        visitor.color("colour", self.color0);
        visitor.color("colour", self.color1);
        visitor.coordinates(self.uv);
    }
};

}  // namespace treefarm
