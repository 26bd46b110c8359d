// SPDX-License-Identifier: Apache-2.0
#include "common/scene/model/scene.h"

#include <gtest/gtest.h>

#include <limits>

#include "coordinator/input/check/validate.h"
#include "tests/support/refusal.h"

namespace treefarm {
namespace {

Scene triangle_scene() {
    Scene scene;
    scene.materials.emplace_back();
    Mesh mesh;
    mesh.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 2)};
    mesh.indices = {0, 1, 2, 0, 2, 3};
    Shape shape;
    shape.geometry = mesh;
    shape.material = 0;
    shape.emitter = 0;
    shape.where = {"s.xml", 7, 3};
    scene.shapes.push_back(shape);
    scene.emitters.push_back({AreaEmitter{Rgb(1.0f), 0}, {"s.xml", 8, 5}});
    return scene;
}

Mesh& mesh_of(Scene& scene) {
    return std::get<Mesh>(scene.shapes[0].geometry);
}

std::string message_of(Scene scene) {
    std::vector<Warning> warnings;
    return test::refusal_of([&] { validate_scene(scene, warnings); }, "no error");
}

TEST(Scene, BoundsAndCounts) {
    Scene scene = triangle_scene();
    EXPECT_EQ(scene.triangle_count(), 2u);
    EXPECT_EQ(scene.environment(), kNone);
    Shape ball;
    ball.geometry = Sphere{Vec3(5, 0, 0), 2.0f, false};
    scene.shapes.push_back(ball);
    scene.emitters.push_back({ConstantEmitter{}, {}});
    EXPECT_EQ(scene.environment(), 1);
    EXPECT_EQ(scene.bounds().min, Vec3(0, -2, -2));
    EXPECT_EQ(scene.bounds().max, Vec3(7, 2, 2));
    EXPECT_TRUE(Scene{}.bounds().isEmpty());
}

TEST(Validate, GoodSceneHasNoWarnings) {
    Scene scene = triangle_scene();
    std::vector<Warning> warnings;
    validate_scene(scene, warnings);
    EXPECT_TRUE(warnings.empty());
    EXPECT_EQ(scene.triangle_count(), 2u);
}

TEST(Validate, DropsTrianglesWithoutArea) {
    Scene scene = triangle_scene();
    mesh_of(scene).indices.insert(mesh_of(scene).indices.begin(), {1, 1, 2});
    std::vector<Warning> warnings;
    validate_scene(scene, warnings);
    EXPECT_EQ(mesh_of(scene).indices, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_EQ(warnings[0].text(), "s.xml:7:3: 1 triangles of the shape have no area and were left out");
}

TEST(Validate, EmptyScenesWarn) {
    Scene scene;
    std::vector<Warning> warnings;
    validate_scene(scene, warnings);
    ASSERT_EQ(warnings.size(), 2u);
    EXPECT_NE(warnings[1].what.find("renders black"), std::string::npos);
}

TEST(Validate, RefusesWhatCannotBeRendered) {
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    const auto refused = [](const std::string& where, auto change) {
        Scene scene = triangle_scene();
        change(scene);
        const std::string message = message_of(scene);
        EXPECT_EQ(message.substr(0, where.size()), where) << message;
        EXPECT_NE(message, "no error");
    };
    refused("s.xml:7:3: ", [](Scene& s) { mesh_of(s).indices[4] = 4; });
    refused("s.xml:7:3: ", [&](Scene& s) { mesh_of(s).positions[3].z = nan; });
    refused("s.xml:7:3: ", [&](Scene& s) { mesh_of(s).positions[0].x = -inf; });
    refused("s.xml:7:3: ", [&](Scene& s) { mesh_of(s).normals = {Vec3(0, 0, 1), Vec3(nan), Vec3(1), Vec3(1)}; });
    refused("s.xml:7:3: ", [](Scene& s) { mesh_of(s).normals = {Vec3(0, 0, 1)}; });
    refused("s.xml:7:3: ", [](Scene& s) { mesh_of(s).uvs.resize(3); });
    refused("s.xml:7:3: ", [](Scene& s) { mesh_of(s).indices.clear(); });
    refused("s.xml:7:3: ", [](Scene& s) { mesh_of(s).indices = {0, 0, 0}; });
    refused("s.xml:7:3: ", [](Scene& s) { mesh_of(s).indices.pop_back(); });
    refused("s.xml:7:3: ", [](Scene& s) { s.shapes[0].geometry = Sphere{Vec3(0.0f), 0.0f, false}; });
    refused("s.xml:7:3: ", [&](Scene& s) { s.shapes[0].geometry = Sphere{Vec3(nan), 1.0f, false}; });
    refused("s.xml:7:3: ", [](Scene& s) { s.shapes[0].material = 1; });
    refused("s.xml:7:3: ", [](Scene& s) { s.shapes[0].emitter = 1; });
    refused("s.xml:8:5: ", [](Scene& s) { std::get<AreaEmitter>(s.emitters[0].kind).radiance.value.y = -1.0f; });
    refused("s.xml:8:5: ", [&](Scene& s) { std::get<AreaEmitter>(s.emitters[0].kind).radiance.value.y = inf; });
    refused("", [](Scene& s) { s.materials[0].bsdf = DiffuseMaterial{Rgb(0.1f, 0.2f, 1.1f)}; });
    refused("", [&](Scene& s) { s.materials[0].bsdf = DiffuseMaterial{Rgb(nan)}; });
    refused("", [](Scene& s) { s.film.width = 0; });
    refused("", [](Scene& s) { s.film.height = 65536; });
    refused("", [](Scene& s) { s.film.filter_radius = 0.0f; });
    refused("", [&](Scene& s) { s.camera.across.x = nan; });
    refused("", [](Scene& s) {
        s.emitters.push_back({ConstantEmitter{}, {}});
        s.emitters.push_back({ConstantEmitter{}, {}});
    });
}

}  // namespace
}  // namespace treefarm
