// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/model/scene.h"

namespace treefarm::test {

/// The scene with all its lengths multiplied: it looks the same, unless it has lights without extent. No instances.
inline Scene scaled(Scene scene, float factor) {
    struct Scaler {
        float factor;
        void operator()(Mesh& mesh) const {
            for (Vec3& p : mesh.positions)
                p *= factor;
        }
        void operator()(Sphere& s) const { s.center *= factor, s.radius *= factor; }
        void operator()(Disk& d) const { d.center *= factor, d.half_u *= factor, d.half_v *= factor; }
        void operator()(Cylinder& c) const { c.p0 *= factor, c.p1 *= factor, c.radius *= factor; }
        void operator()(Instance&) const {}
    };
    for (Shape& shape : scene.shapes)
        std::visit(Scaler{factor}, shape.geometry);
    for (Vec3* v : {&scene.camera.origin, &scene.camera.corner, &scene.camera.across, &scene.camera.down,
                    &scene.camera.lens_u, &scene.camera.lens_v})
        *v *= factor;
    return scene;
}

}  // namespace treefarm::test
