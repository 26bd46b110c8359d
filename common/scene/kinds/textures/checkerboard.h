// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/kinds/traits/texture_traits.h"

namespace treefarm {

/// Squares of half a unit: color0 where u and v are both in the lower or both in the upper half of their unit.
struct CheckerboardTexture {
    Rgb color0{0.4f}, color1{0.2f};
    UvTransform uv;

    static constexpr KindEffect kEffect{"checkerboards", "checkerboard"};
    ValueRange range(const auto&) const {
        ValueRange range{color0.x, color0.x};
        for (const Rgb& color : {color0, color1})
            for (int i = 0; i < 3; ++i)
                range = range.with(color[i]);
        return range;
    }
    Rgb mean(const auto&) const { return (color0 + color1) * 0.5f; }
    static void fields(auto& self, auto& visitor) {
        visitor.color("colour", self.color0);
        visitor.color("colour", self.color1);
        visitor.coordinates(self.uv);
    }
};

}  // namespace treefarm
