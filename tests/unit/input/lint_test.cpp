// SPDX-License-Identifier: Apache-2.0
// What inspection of a scene finds, and none where there is none; as a command: check_command_test.
#include "coordinator/input/lint/lint.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "coordinator/input/load.h"
#include "tests/support/support.h"
#include "tests/support/test_scenes.h"

namespace treefarm {
namespace {

std::set<std::string> kinds_of(const std::vector<Finding>& findings) {
    std::set<std::string> kinds;
    for (const Finding& finding : findings)
        kinds.insert(finding.kind);
    return kinds;
}

const Finding* find(const std::vector<Finding>& findings, const std::string& kind) {
    const auto at = std::find_if(findings.begin(), findings.end(), [&](const Finding& f) { return f.kind == kind; });
    return at == findings.end() ? nullptr : &*at;
}

TEST(Lint, FindsNothingInASoundScene) {
    const std::vector<Finding> findings = lint(test::cornell_box(1.0f, Vec3(0.0f)));
    EXPECT_TRUE(findings.empty()) << findings[0].text();
}

TEST(Lint, OwnScenesHaveNoErrors) {
    for (const char* name : {"cornell-box", "glossy-room", "mixed-room", "diffuse-room", "caustic", "door-ajar",
                             "white-furnace", "features"})
        for (const Finding& f : lint(load_scene_to_check(test::own_scene(std::string(name) + ".xml")).scene))
            EXPECT_NE(f.severity, Finding::Severity::error) << f.text();
}

TEST(Lint, NumbersThatAreNone) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (int what = 0; what < 4; ++what) {
        Scene scene = test::cornell_box(1.0f, Vec3(0.0f));
        auto& mesh = std::get<Mesh>(scene.shapes[2].geometry);
        scene.shapes[2].where = {"a.xml", 7, 3};
        if (what == 0) mesh.positions[1].y = nan;
        if (what == 1) mesh.normals.assign(mesh.positions.size(), Vec3(0, 0, nan));
        if (what == 2) mesh.uvs.assign(mesh.positions.size(), Vec2(nan, 0));
        if (what == 3) mesh.indices[0] = 1000;
        const std::vector<Finding> findings = lint(scene);
        ASSERT_FALSE(findings.empty()) << what;
        EXPECT_EQ(findings[0].kind, what == 3 ? "bad indices" : "numbers");
        EXPECT_EQ(findings[0].severity, Finding::Severity::error);
        EXPECT_NE(findings[0].text().find("a.xml:7:3: error: "), std::string::npos) << findings[0].text();
    }
    Scene scene = test::cornell_box(1.0f, Vec3(0.0f));
    std::get<AreaEmitter>(scene.emitters[0].kind).radiance.value.x = nan;
    EXPECT_TRUE(find(lint(scene), "numbers"));
}

TEST(Lint, ScaleAndPosition) {
    const auto kinds = [](float scale, const Vec3& offset) { return kinds_of(lint(test::cornell_box(scale, offset))); };
    EXPECT_TRUE(kinds(1e-5f, Vec3(0.0f)).contains("scale"));
    EXPECT_TRUE(kinds(1e8f, Vec3(0.0f)).contains("scale"));
    EXPECT_TRUE(kinds(1.0f, Vec3(1e5f)).contains("far from origin"));
    EXPECT_TRUE(kinds(100.0f, Vec3(1e3f)).empty());
    Scene scene = test::cornell_box(1.0f, Vec3(0.0f));
    scene.camera.origin = Vec3(0, 0, -1e6f);
    EXPECT_TRUE(find(lint(scene), "distant camera"));
}

TEST(Lint, ARoomFarFromTheOriginOfItsScene) {
    const auto room_at = [](float away, float ground) {
        Scene scene = test::furnace(0.5f, 1.0f, 1.0f, Vec3(away, 0.0f, 0.0f));
        scene.shapes[0].where = {"a.xml", 7, 3};
        test::add_shape(scene, test::quad(Vec3(-ground, -9, -ground), Vec3(0, 0, 2 * ground), Vec3(2 * ground, 0, 0)),
                        0);
        return lint(scene);
    };
    EXPECT_FALSE(find(room_at(40.0f, 3000.0f), "far room"));
    const std::vector<Finding> findings = room_at(1000.0f, 3000.0f);
    const Finding* far = find(findings, "far room");
    ASSERT_TRUE(far);
    EXPECT_EQ(far->severity, Finding::Severity::warning);
    EXPECT_EQ(far->where.line, 7);
    EXPECT_NE(far->cure.find("farm.robust"), std::string::npos);
    // The scene as a whole is far: a render moves it.
    EXPECT_FALSE(find(lint(test::furnace(0.5f, 1.0f, 1.0f, Vec3(1e4f, 0.0f, 0.0f))), "far room"));
}

TEST(Lint, EmittersAreReachableFromTheirFront) {
    Scene scene = test::cornell_box(1.0f, Vec3(0.0f));
    // Turned to the ceiling, which is above it: reached. Above the ceiling, facing up: not.
    auto& lamp = std::get<Mesh>(scene.shapes.back().geometry);
    std::swap(lamp.indices[1], lamp.indices[2]);
    std::swap(lamp.indices[4], lamp.indices[5]);
    EXPECT_FALSE(find(lint(scene), "unreachable emitter"));
    for (Vec3& p : lamp.positions)
        p.y = 1.5f;
    const std::vector<Finding> findings = lint(scene);
    EXPECT_TRUE(find(findings, "unreachable emitter"));
}

TEST(Lint, ConesOfPointsHitSomething) {
    Scene scene;
    test::add_shape(scene, test::quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), kNone);
    scene.camera.origin = Vec3(0, 0, 3);
    const auto unreachable = [&](decltype(Emitter::kind) kind) {
        scene.emitters = {{std::move(kind), {}}};
        return find(lint(scene), "unreachable emitter") != nullptr;
    };
    for (const float side : {-1.0f, 1.0f}) {
        const Vec3 at(0, 0, 3), axis(0, 0, side);
        EXPECT_EQ(unreachable(SpotEmitter{at, axis}), side > 0);
        EXPECT_EQ(unreachable(ProjectorEmitter{at, axis, Vec3(1, 0, 0), Vec3(0, 1, 0), 0.2f, 0.1f}), side > 0);
        EXPECT_EQ(unreachable(DirectionalEmitter{axis}), false);
    }
    EXPECT_FALSE(unreachable(PointEmitter{Vec3(0, 0, 3)}));
    // The corner of the picture is what reaches it.
    const Vec3 axis = normalize(Vec3(2.5f, 0, -1));
    EXPECT_TRUE(
        unreachable(ProjectorEmitter{Vec3(0, 0, 3), axis, cross(Vec3(0, 1, 0), axis), Vec3(0, 1, 0), 0.1f, 0.1f}));
    EXPECT_FALSE(
        unreachable(ProjectorEmitter{Vec3(0, 0, 3), axis, cross(Vec3(0, 1, 0), axis), Vec3(0, 1, 0), 1.0f, 0.1f}));
}

/// An index of 1 makes glass invisible, and only that.
TEST(Lint, OpaqueSurfacesOfIndex1AreVisible) {
    Scene scene = test::cornell_box(1.0f, Vec3(0.0f));
    PrincipledMaterial principled;
    PlasticMaterial plastic;
    DielectricMaterial glass;
    principled.eta = plastic.eta = glass.eta = 1.0f;
    scene.materials[0].bsdf = principled;
    EXPECT_FALSE(kinds_of(lint(scene)).contains("extreme ior"));
    scene.materials[0].bsdf = plastic;
    EXPECT_FALSE(kinds_of(lint(scene)).contains("extreme ior"));
    scene.materials[0].bsdf = glass;
    EXPECT_TRUE(kinds_of(lint(scene)).contains("extreme ior"));
}

TEST(Lint, AnisotropyNeedsTextureCoordinates) {
    Scene scene = test::cornell_box(1.0f, Vec3(0.0f));
    const std::size_t shape = scene.shapes.size();
    Mesh mesh = test::quad({0.2f, 0.2f, 0.2f}, {0, 0.1f, 0}, {0.1f, 0, 0});
    test::add_shape(scene, mesh, test::add_diffuse(scene, Rgb(0.5f)));
    const auto add = [&](decltype(Material::bsdf) bsdf) {
        scene.materials.back().bsdf = std::move(bsdf);
        std::get<Mesh>(scene.shapes[shape].geometry).uvs.clear();
        EXPECT_TRUE(kinds_of(lint(scene)).contains("anisotropy without uv"));
        std::get<Mesh>(scene.shapes[shape].geometry).uvs = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};
        EXPECT_FALSE(kinds_of(lint(scene)).contains("anisotropy without uv"));
    };
    ConductorMaterial metal;
    metal.roughness = {Microfacets::ggx, 0.1f, 0.4f};
    add(metal);
    PrincipledMaterial principled;
    principled.anisotropic = 0.5f;
    add(principled);
    metal.roughness = {Microfacets::ggx, 0.1f, 0.1f};
    scene.materials.back().bsdf = metal;
    std::get<Mesh>(scene.shapes[shape].geometry).uvs.clear();
    EXPECT_FALSE(kinds_of(lint(scene)).contains("anisotropy without uv"));
}

}  // namespace
}  // namespace treefarm
