// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/support/light_checks.h"
#include "tests/support/test_scenes.h"

namespace treefarm {
namespace {

using test::add_shape;
using test::expect_irradiance;
using test::expect_light_distribution;
using test::quad;

Scene only(decltype(Shape::geometry) geometry) {
    Scene scene;
    add_shape(scene, std::move(geometry), kNone, Rgb(1.0f));
    return scene;
}

TEST(LightDistribution, Rectangle) {
    expect_light_distribution(only(quad({-2, -2, 1.5f}, {0, 4, 0}, {4, 0, 0})), Vec3(0.3f, 0.1f, 0), "rectangle");
}

TEST(LightDistribution, ConvexMesh) {
    expect_light_distribution(only(test::box(Vec3(-1, -1, 1), Vec3(1.5f, 1, 2), false)), Vec3(0.2f, 0.1f, -0.2f),
                              "box");
}

TEST(LightDistribution, RoomSeenFromInside) {
    expect_light_distribution(only(test::box(Vec3(-1, -1.5f, -1), Vec3(1, 1, 2), true)), Vec3(0.2f, 0.1f, -0.2f),
                              "room");
}

TEST(LightDistribution, SphereFromOutside) {
    expect_light_distribution(only(Sphere{Vec3(1, 2, 3), 2.5f, false}), Vec3(0.0f), "sphere");
}

TEST(LightDistribution, SphereFromInside) {
    expect_light_distribution(only(Sphere{Vec3(0.3f, 0.2f, 0.1f), 2.5f, true}), Vec3(1.0f, 0.5f, 0), "inside a sphere");
}

TEST(LightDistribution, Environment) {
    Scene scene;
    add_shape(scene, quad({-1, -1, 1}, {2, 0, 0}, {0, 2, 0}), kNone);
    scene.emitters.push_back({ConstantEmitter{Rgb(1.0f)}, {}});
    expect_light_distribution(scene, Vec3(0.0f), "environment");
}

TEST(LightDistribution, SeveralAtOnce) {
    Scene scene = only(quad({-2, -2, 2}, {0, 4, 0}, {4, 0, 0}));
    add_shape(scene, Sphere{Vec3(3, 0, 0), 1.0f, false}, kNone, Rgb(2.0f));
    scene.emitters.push_back({ConstantEmitter{Rgb(0.5f)}, {}});
    expect_light_distribution(scene, Vec3(0.1f, 0.2f, 0), "several");
}

/// Form factor from a small patch to a parallel rectangle a x b at distance h above its corner (Howell's catalogue,
/// B-3).
double corner_form_factor(double a, double b, double h) {
    const double x = a / h, y = b / h;
    const double rx = std::sqrt(1 + x * x), ry = std::sqrt(1 + y * y);
    return (x / rx * std::atan(y / rx) + y / ry * std::atan(x / ry)) / (2 * M_PI);
}

TEST(LightIrradiance, ParallelRectangles) {
    for (const double size : {1e-3, 1.0, 1e3})
        for (const double ratio : {0.03, 1.0, 30.0}) {
            const double h = size / ratio;
            const auto s = static_cast<float>(size);
            const Scene scene = only(quad({0, 0, float(h)}, {0, s, 0}, {s, 0, 0}));
            const double exact =
                M_PI *
                (corner_form_factor(0.25 * size, 0.5 * size, h) + corner_form_factor(0.75 * size, 0.5 * size, h)) * 2;
            expect_irradiance(scene, Vec3(0.25f * s, 0.5f * s, 0), Vec3(0, 0, 1), exact,
                              "size " + std::to_string(size) + " ratio " + std::to_string(ratio));
        }
}

TEST(LightIrradiance, Spheres) {
    const Vec3 n = normalize(Vec3(0.5f, 0.2f, 1));
    for (const double radius : {1e-3, 0.5, 1e3})
        for (const double ratio : {1e-3, 0.1, 0.6}) {
            const double distance = radius / ratio;
            const Scene scene = only(Sphere{Vec3(0, 0, float(distance)), float(radius), false});
            // The whole sphere is above the horizon of n: the cosine at its centre times the projected disk.
            expect_irradiance(scene, Vec3(0.0f), n, M_PI * ratio * ratio * n.z,
                              "radius " + std::to_string(radius) + " ratio " + std::to_string(ratio));
        }
}

TEST(LightIrradiance, InsideASphere) {
    expect_irradiance(only(Sphere{Vec3(1, 1, 1), 3.0f, true}), Vec3(2, 0.5f, 1), Vec3(0, 0, 1), M_PI, "inside");
}

TEST(LightIrradiance, TessellatedSphereComesCloseToTheTrueOne) {
    const Scene scene = only(test::sphere_mesh(Vec3(0, 0, 4), 1.0f, 5, true));
    const test::Irradiance e = test::irradiance(scene, Vec3(0.0f), Vec3(0, 0, 1), 200000);
    EXPECT_NEAR(e.both, M_PI / 16, 4.5 * e.both_error + 2e-3 * M_PI / 16);
}

}  // namespace
}  // namespace treefarm
