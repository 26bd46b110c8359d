// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "common/scene/kinds/traits/texture_traits.h"

namespace treefarm {

/// Lines of color1 along the borders of unit squares of color0 (Mitsuba 0.6's gridtexture).
struct GridTexture {
    Rgb color0{0.2f}, color1{0.4f};
    float line_width = 0.01f;  ///< half the width of a line, in units of u and v
    UvTransform uv;

    static constexpr KindEffect kEffect{"grids", "grid"};
    ValueRange range(const auto&) const { return range_of_colors(color0, color1); }
    Rgb mean(const auto&) const {
        const float inside = std::clamp(1.0f - 2.0f * line_width, 0.0f, 1.0f);
        return color1 + (color0 - color1) * (inside * inside);
    }
    static void fields(auto& self, auto& visitor) {
        visitor.color("colour", self.color0);
        visitor.color("colour", self.color1);
        visitor.extent("line width", self.line_width);
        visitor.coordinates(self.uv);
    }
};

}  // namespace treefarm
