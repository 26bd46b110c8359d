// SPDX-License-Identifier: Apache-2.0
// Why an image may be black: what dark_causes() finds, and that it finds nothing where there is light.
#include <gtest/gtest.h>

#include "coordinator/input/lint/lint.h"
#include "coordinator/input/load.h"
#include "tests/support/support.h"
#include "tests/support/test_scenes.h"

namespace treefarm {
namespace {

/// The only kinds that are found, in their order.
std::vector<std::string> kinds(const Scene& scene) {
    std::vector<std::string> found;
    for (const Finding& finding : dark_causes(scene))
        found.push_back(finding.kind);
    return found;
}

using Kinds = std::vector<std::string>;

std::int32_t add_glass(Scene& scene, float alpha = 0.0f) {
    DielectricMaterial glass;
    if (alpha > 0.0f) glass.roughness = {Microfacets::ggx, alpha, alpha};
    Material material;
    material.bsdf = glass;
    scene.materials.push_back(material);
    return static_cast<std::int32_t>(scene.materials.size()) - 1;
}

void add_light(Scene& scene, const Vec3& position) {
    scene.emitters.push_back({PointEmitter{position, Rgb(1.0f)}, {}});
}

/// A closed room, its camera and a point light inside.
Scene room(bool inwards, bool twosided) {
    Scene scene;
    test::add_shape(scene, test::box(Vec3(-1.0f), Vec3(1.0f), inwards), test::add_diffuse(scene, Rgb(0.5f), twosided));
    add_light(scene, Vec3(0.0f, 0.5f, 0.0f));
    scene.camera = test::look_at(Vec3(0, 0, 0.9f), Vec3(0.0f), Vec3(0, 1, 0), 0.8f);
    return scene;
}

TEST(Darkness, WallsThatFaceOutwards) {
    EXPECT_EQ(kinds(room(false, false)), (Kinds{"lights backs only", "seen from behind"}));
    EXPECT_EQ(kinds(room(false, true)), Kinds{}) << "both sides";
    EXPECT_EQ(kinds(room(true, false)), Kinds{}) << "inwards";
}

TEST(Darkness, LightsBehindSmoothGlass) {
    Scene scene = room(true, false);
    const std::int32_t smooth = add_glass(scene), rough = add_glass(scene, 0.2f);
    test::add_shape(scene, Sphere{Vec3(0.0f, 0.5f, 0.0f), 0.1f}, smooth);
    EXPECT_EQ(kinds(scene), Kinds{"light behind glass"});
    scene.shapes.back().material = rough;
    EXPECT_EQ(kinds(scene), Kinds{}) << "next event finds it behind rough glass";
    scene.shapes.back().material = smooth;
    scene.emitters.clear();
    test::add_shape(scene, Sphere{Vec3(0.0f, 0.5f, 0.0f), 0.05f}, 0, Rgb(1.0f));
    const std::vector<Finding> found = dark_causes(scene);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].severity, Finding::Severity::note) << "chance finds one that has an area";
}

std::int32_t add_mirror(Scene& scene) {
    Material material;
    material.bsdf = ConductorMaterial{};
    scene.materials.push_back(material);
    return static_cast<std::int32_t>(scene.materials.size()) - 1;
}

/// A floor that reaches far, and the camera above it.
Scene floor_from_above() {
    Scene scene;
    test::add_shape(scene, test::quad({-50, 0, -50}, {0, 0, 100}, {100, 0, 0}), test::add_diffuse(scene, Rgb(0.5f)));
    scene.camera = test::look_at(Vec3(0, 9, 0), Vec3(0.0f), Vec3(0, 0, 1), 0.4f);
    return scene;
}

/// Light that comes to what the camera sees through smooth glass alone, whatever else it meets.
TEST(Darkness, PointsAboveGlassThatCoversTheView) {
    Scene scene = floor_from_above();
    const std::int32_t glass = add_glass(scene);
    test::add_shape(scene, test::box({-6, 1, -6}, {6, 1.5f, 6}, false), glass);
    add_light(scene, Vec3(0, 3, 0));
    EXPECT_EQ(kinds(scene), Kinds{"light behind glass"});
    scene.shapes.back().geometry = Sphere{Vec3(0, 3, 0), 1.0f};
    EXPECT_EQ(kinds(scene), Kinds{"light behind glass"});
    scene.emitters = {{DirectionalEmitter{Vec3(0, -1, 0)}, {}}};
    scene.shapes.back().geometry = test::box({-60, 1, -60}, {60, 1.5f, 60}, false);
    EXPECT_EQ(kinds(scene), Kinds{"light behind glass"}) << "from one side";
    scene.shapes.back().geometry = test::box({0, 1, -6}, {6, 1.5f, 6}, false);
    EXPECT_EQ(kinds(scene), Kinds{}) << "half of the view is lit";
}

/// A lamp in a housing that is open towards a mirror.
TEST(Darkness, LightByMirrorsAlone) {
    Scene scene = floor_from_above();
    SpotEmitter spot;
    spot.position = Vec3(0, 2, 0);
    spot.axis = Vec3(0, 1, 0);
    spot.cutoff = spot.beam = 0.2f;
    scene.emitters = {{spot, {}}};
    const std::int32_t mirror = add_mirror(scene);
    test::add_shape(scene, test::quad({-1, 4, -1}, {2, 0, 0}, {0, 0, 2}), mirror);
    scene.camera = test::look_at(Vec3(0, 3, -9), Vec3(0.0f), Vec3(0, 1, 0), 0.3f);
    EXPECT_EQ(kinds(scene), Kinds{"light by mirrors"});
    spot.axis = Vec3(0, -1, 0);
    scene.emitters = {{spot, {}}};
    EXPECT_EQ(kinds(scene), Kinds{});
}

TEST(Darkness, LampsThatAreInsideOut) {
    for (const bool flipped : {false, true}) {
        Scene scene = floor_from_above();
        test::add_shape(scene, Sphere{Vec3(0, 2, 0), 0.5f, flipped}, 0, Rgb(3.0f), "lamp");
        EXPECT_EQ(kinds(scene), flipped ? Kinds{"inside-out emitter"} : Kinds{});
        scene.shapes.back().geometry = test::box({-0.5f, 2, -0.5f}, {0.5f, 3, 0.5f}, flipped);
        EXPECT_EQ(kinds(scene), flipped ? Kinds{"inside-out emitter"} : Kinds{});
        if (!flipped) continue;
        scene.shapes.back().geometry = Sphere{Vec3(0.0f), 100.0f, true};
        EXPECT_EQ(kinds(scene), Kinds{}) << "a sky";
    }
}

TEST(Darkness, SentencesHaveNoSeverity) {
    const std::vector<Finding> found = dark_causes(floor_from_above());
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].sentence(), "the scene has no emitters; add one");
}

TEST(Darkness, EmittersThatFaceAWall) {
    Scene scene = room(true, false);
    scene.emitters.clear();
    // Upwards, right below the ceiling.
    test::add_shape(scene, test::quad(Vec3(-0.2f, 0.9999f, -0.2f), Vec3(0, 0, 0.4f), Vec3(0.4f, 0, 0)), 0, Rgb(5.0f),
                    "lamp");
    EXPECT_EQ(kinds(scene), Kinds{"covered emitter"});
    scene.shapes.back().geometry = test::quad(Vec3(-0.2f, 0.9999f, -0.2f), Vec3(0.4f, 0, 0), Vec3(0, 0, 0.4f));
    EXPECT_EQ(kinds(scene), Kinds{}) << "downwards";
}

TEST(Darkness, CamerasInsideClosedShapes) {
    Scene scene = room(false, true);
    std::get<PointEmitter>(scene.emitters[0].kind).position = Vec3(0, 3, 0);
    test::add_shape(scene, Sphere{Vec3(0.0f), 9.0f, true}, 0);
    EXPECT_EQ(kinds(scene), Kinds{"camera inside"});
    add_light(scene, Vec3(0.0f));
    EXPECT_EQ(kinds(scene), Kinds{}) << "a lamp is there, too";
    scene.camera = test::look_at(Vec3(0, 0, 5.0f), Vec3(0.0f), Vec3(0, 1, 0), 0.8f);
    EXPECT_EQ(kinds(scene), Kinds{});
}

TEST(Darkness, NothingInView) {
    Scene scene = room(true, false);
    scene.camera = test::look_at(Vec3(0, 0, 5.0f), Vec3(0, 0, 10.0f), Vec3(0, 1, 0), 0.8f);
    EXPECT_EQ(kinds(scene), Kinds{"nothing in view"});
    scene.emitters.push_back({ConstantEmitter{}, {}});
    EXPECT_EQ(kinds(scene), Kinds{}) << "the sky";
    scene.emitters.clear();
    scene.camera = room(true, false).camera;
    EXPECT_EQ(kinds(scene), Kinds{"no emitters"});
}

TEST(Darkness, InstancesAreLookedInto) {
    Scene scene = room(false, false);
    scene.shapes[0].group = 0;
    scene.group_count = 1;
    Shape placed;
    Imath::M44f to_world;
    to_world.setScale(Vec3(2.0f));
    placed.geometry = Instance{0, to_world};
    scene.shapes.push_back(placed);
    EXPECT_EQ(kinds(scene), (Kinds{"lights backs only", "seen from behind"}));
    std::get<Mesh>(scene.shapes[0].geometry) = test::box(Vec3(-1.0f), Vec3(1.0f), true);
    EXPECT_EQ(kinds(scene), Kinds{});
}

TEST(Darkness, OwnScenesAreLit) {
    for (const char* name : {"cornell-box", "glossy-room", "mixed-room", "diffuse-room", "caustic", "door-ajar",
                             "white-furnace", "features"})
        for (const Finding& f : dark_causes(load_scene(test::own_scene(std::string(name) + ".xml")).scene))
            ADD_FAILURE() << name << ": " << f.text();
}

}  // namespace
}  // namespace treefarm
