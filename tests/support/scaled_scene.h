// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/scene/model/scene.h"
#include "tests/support/hard_case.h"
#include "tests/support/material_scenes.h"

namespace treefarm::test {

/// Scene with all lengths multiplied: its image is unchanged, unless it has lights without extent. No instances.
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

/// Rooms of a few pixels for scaling: with diffuse walls, and with metal, glass, plastic and a lens.
inline std::vector<Scene> rooms_to_scale() {
    std::vector<Scene> rooms = {cornell_box(1.0f, Vec3(0.0f)), glossy_room()};
    rooms[1].camera.lens_u = Vec3(0.02f, 0, 0);
    rooms[1].camera.lens_v = Vec3(0, 0.02f, 0);
    for (Scene& room : rooms)
        set_film(room, 12, 12);
    return rooms;
}

/// Compares an image with another one `factor` times as bright, a power of two, bit by bit.
inline void expect_same_bits(const LocalRender& image, const LocalRender& other, double factor,
                             const std::string& what) {
    EXPECT_GT(mean_of(image.image).value, 0.0) << what << ": black";
    for (std::size_t i = 0; i < image.image.mean.size(); ++i) {
        ASSERT_EQ(image.image.mean[i] * factor, other.image.mean[i]) << what << ", pixel " << i;
        ASSERT_EQ(image.image.variance[i] * (factor * factor), other.image.variance[i]) << what << ", pixel " << i;
    }
}

}  // namespace treefarm::test
