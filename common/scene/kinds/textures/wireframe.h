// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/kinds/traits/texture_traits.h"

namespace treefarm {

/// Edges of a mesh's triangles in another colour than their inside, with a smooth step between (Mitsuba 0.6's
/// wireframe). Shapes that are no meshes have the colour of the inside.
struct WireframeTexture {
    Rgb edge{0.1f}, interior{0.5f};
    float line_width = 0.0f;  ///< distance from an edge at which the inside begins, in scene units
    float step_width = 0.5f;  ///< share of it that the step takes, 0 to 1

    static constexpr KindEffect kEffect{"wireframes", "wireframe"};
    ValueRange range(const auto&) const { return range_of_colors(edge, interior); }
    Rgb mean(const auto&) const { return (edge + interior) * 0.5f; }
    static void fields(auto& self, auto& visitor) {
        visitor.color("colour", self.edge);
        visitor.color("colour", self.interior);
        visitor.extent("line width", self.line_width);
        visitor.extent("step width", self.step_width);
    }
};

}  // namespace treefarm
