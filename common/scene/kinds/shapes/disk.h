// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/kinds/shapes/shape_traits.h"

namespace treefarm {

/// A flat ellipse: center + a * half_u + b * half_v for a^2 + b^2 <= 1; its front is where cross(half_u, half_v)
/// points. Texture coordinates: (radius, azimuth over 2 pi) of (a, b).
struct Disk {
    Vec3 center{0.0f};
    Vec3 half_u{1.0f, 0.0f, 0.0f},
        half_v{0.0f, 1.0f, 0.0f};  ///< half axes, not parallel, not necessarily at right angles
    bool mirrored = false;         ///< the azimuth is that of (a, -b)

    Box3 box() const { return box_about(center, ellipse_extent(half_u, half_v)); }
    /// Whether the half axes span a plane: neither is too short, or parallel to the other.
    bool spans_plane() const {
        const float longest = std::max(half_u.length(), half_v.length());
        return longest > 0.0f && cross(half_u * (1.0f / longest), half_v * (1.0f / longest)).length() > 1e-6f;
    }
    static void fields(auto& self, auto& visitor) {
        visitor.point("center", self.center);
        visitor.offset("first half axis", self.half_u);
        visitor.offset("second half axis", self.half_v);
        visitor.rule(self.spans_plane(), "has no area", "give its transformation no scale of 0");
        visitor.flag("mirrored", self.mirrored);
    }
};

}  // namespace treefarm
