// SPDX-License-Identifier: Apache-2.0
// Which estimator is recommended for a scene, and what a few rays say of how light comes to what is seen.
#include "coordinator/input/lint/estimator_advice.h"

#include <gtest/gtest.h>

#include "coordinator/input/lint/light_reach.h"
#include "coordinator/input/load.h"
#include "tests/support/test_scenes.h"

namespace treefarm {
namespace {

std::string advice(const Scene& scene) {
    const EstimatorAdvice advice = estimator_advice(scene, resolve({}, scene));
    return advice.type + ": " + advice.reason;
}

/// A floor that the camera sees, a lamp above it, and what is put between.
Scene floor_and_lamp() {
    Scene scene;
    test::add_shape(scene, test::quad({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}), test::add_diffuse(scene, Rgb(0.5f)));
    test::add_shape(scene, test::quad({-0.2f, 3, -0.2f}, {0.4f, 0, 0}, {0, 0, 0.4f}), kNone, Rgb(30.0f));
    scene.camera = test::look_at({0, 1, -3}, {0, 0, 0}, {0, 1, 0}, 0.3f);
    test::set_film(scene, 16, 16);
    return scene;
}

TEST(LightReach, WhatLiesBetween) {
    const LightReach open = light_reach(floor_and_lamp());
    ASSERT_TRUE(open.known);
    EXPECT_EQ(open.free, 1);
    EXPECT_EQ(open.infinity, 0);
    EXPECT_EQ(advice(floor_and_lamp()).substr(0, 5), "path:");

    Scene hidden = floor_and_lamp();
    test::add_shape(hidden, test::quad({-4, 2, -4}, {0, 0, 8}, {8, 0, 0}), 0);
    EXPECT_EQ(light_reach(hidden).blocked, 1);
    EXPECT_EQ(advice(hidden).substr(0, 14), "bidirectional:");

    Scene glass = floor_and_lamp();
    glass.materials.push_back({});
    glass.materials.back().bsdf = DielectricMaterial{};
    test::add_shape(glass, test::quad({-4, 2, -4}, {0, 0, 8}, {8, 0, 0}), 1);
    EXPECT_EQ(light_reach(glass).glass, 1);
    EXPECT_EQ(advice(glass).substr(0, 14), "bidirectional:");

    Scene away = floor_and_lamp();
    std::swap(std::get<Mesh>(away.shapes[1].geometry).indices[1], std::get<Mesh>(away.shapes[1].geometry).indices[2]);
    std::swap(std::get<Mesh>(away.shapes[1].geometry).indices[4], std::get<Mesh>(away.shapes[1].geometry).indices[5]);
    EXPECT_EQ(light_reach(away).blocked, 1) << "it shines at the ceiling";

    Scene sky = floor_and_lamp();
    sky.emitters.push_back({ConstantEmitter{Rgb(5.0f)}, {}});
    EXPECT_GT(light_reach(sky).infinity, 0.5);
    EXPECT_EQ(advice(sky).substr(0, 5), "path:");

    EXPECT_FALSE(light_reach(Scene{}).known);
}

TEST(EstimatorAdvice, OfPointsOverMirrors) {
    Scene scene = floor_and_lamp();
    scene.emitters.push_back({PointEmitter{{0, 1, 0}, Rgb(1.0f)}, {}});
    EXPECT_EQ(advice(scene).substr(0, 5), "path:");
    scene.materials[0].bsdf = ConductorMaterial{};
    EXPECT_EQ(advice(scene).substr(0, 14), "bidirectional:");
}

/// As measured (bench/log/bidirectional.md, "where is it ahead of path tracing"): the estimator that is ahead at equal
/// time.
TEST(EstimatorAdvice, OfOurScenes) {
    for (const auto& [name, type] : {std::pair("fixtures", "bidirectional:"),
                                     {"door-ajar", "bidirectional:"},
                                     {"classroom", "path:"},
                                     {"plates", "path:"},
                                     {"white-furnace", "path:"}}) {
        const LoadedScene loaded =
            load_scene(TREEFARM_SOURCE_DIR "/configs/scenes/" + std::string(name) + ".xml", {}, false, 48, 32);
        EXPECT_TRUE(advice(loaded.scene).starts_with(type)) << name << ": " << advice(loaded.scene);
    }
}

}  // namespace
}  // namespace treefarm
