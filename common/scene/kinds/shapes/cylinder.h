// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/kinds/shapes/shape_traits.h"

namespace treefarm {

/// Side of a cylinder, without caps. Texture coordinates: (azimuth from `meridian` over 2 pi, position along the axis).
struct Cylinder {
    Vec3 p0{0.0f}, p1{0.0f, 0.0f, 1.0f};
    float radius = 1.0f;
    bool flip_normals = false;        ///< normals point inwards
    Vec3 meridian{1.0f, 0.0f, 0.0f};  ///< unit length, at right angles to the axis
    bool mirrored = false;            ///< the azimuth runs clockwise about the axis

    float length() const { return (p1 - p0).length(); }
    bool is_meridian_across() const {
        const float along = length();
        return along > 0.0f && at_right_angles((p1 - p0) * (1.0f / along), meridian);
    }
    Box3 box() const {
        const Vec3 axis = normalize(p1 - p0);
        const Vec3 u = meridian * radius, extent = ellipse_extent(u, cross(axis, u));
        Box3 box = box_about(p0, extent);
        box.extendBy(box_about(p1, extent));
        return box;
    }
    static void fields(auto& self, auto& visitor) {
        visitor.point("first end", self.p0);
        visitor.point("second end", self.p1);
        visitor.rule(self.length() > 0.0f, "has no length", "move p0 and p1 apart");
        visitor.radius(self.radius);
        visitor.flag("flip_normals", self.flip_normals);
        visitor.axis("meridian", self.meridian);
        visitor.rule(self.is_meridian_across(), "has axes that are not at right angles", "check its transformation");
        visitor.flag("mirrored", self.mirrored);
    }
};

}  // namespace treefarm
