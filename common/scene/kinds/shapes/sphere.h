// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/kinds/shapes/shape_traits.h"

namespace treefarm {

/// An analytic sphere. Texture coordinates: (azimuth about `pole` from `meridian` over 2 pi, angle from `pole` over
/// pi).
struct Sphere {
    Vec3 center{0.0f};
    float radius = 1.0f;
    bool flip_normals = false;                                ///< normals point inwards
    Vec3 pole{0.0f, 0.0f, 1.0f}, meridian{1.0f, 0.0f, 0.0f};  ///< unit length, at right angles
    bool mirrored = false;                                    ///< the azimuth runs clockwise about the pole

    Box3 box() const { return box_about(center, Vec3(radius)); }
    static void fields(auto& self, auto& visitor) {
        visitor.point("center", self.center);
        visitor.radius(self.radius);
        visitor.flag("flip_normals", self.flip_normals);
        visitor.axis("pole", self.pole);
        visitor.axis("meridian", self.meridian);
        visitor.rule(at_right_angles(self.pole, self.meridian), "has axes that are not at right angles",
                     "check its transformation");
        visitor.flag("mirrored", self.mirrored);
    }
};

}  // namespace treefarm
