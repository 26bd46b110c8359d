// SPDX-License-Identifier: Apache-2.0
// The plan of each scene: which effects are on, and the kernels. Facts, not text.
#include <gtest/gtest.h>

#include <set>

#include "common/config/job_reader.h"
#include "common/plan/effects/effects.h"
#include "coordinator/input/load.h"
#include "tests/support/support.h"

namespace treefarm {
namespace {

using Names = std::set<std::string>;

struct Planned {
    Scene scene;
    EffectPlan plan;
};

Planned planned(const std::string& file) {
    LoadedScene loaded = load_scene(file);
    Job job;
    apply_layer(job, loaded.settings);
    EffectPlan plan = plan_effects(loaded.scene, job);
    return {std::move(loaded.scene), std::move(plan)};
}

/// Names of what is on because the scene calls for it: what the job decides is not the scene's.
Names scene_effects(const EffectPlan& plan) {
    Names names;
    for (const Effect& effect : plan.effects)
        if (effect.on && effect.group != "transport" && effect.name != "next_event" && effect.name != "mis")
            names.insert(effect.name);
    return names;
}

void expect_plan(const std::string& file, const Names& expected, const std::string& last_kernel) {
    EXPECT_TRUE(load_scene(file).warnings.empty());
    const EffectPlan plan = planned(file).plan;
    const Names on = scene_effects(plan);
    for (const std::string& name : expected)
        EXPECT_TRUE(on.contains(name)) << file << " should have " << name;
    for (const std::string& name : on)
        EXPECT_TRUE(expected.contains(name)) << file << " should not have " << name << ": " << plan.find(name)->reason;
    for (const Effect& effect : plan.effects)
        if (on.contains(effect.name) && effect.group != "camera") {
            EXPECT_GT(effect.where.line, 0) << effect.name;
        }
    ASSERT_FALSE(plan.kernels.empty());
    EXPECT_EQ(plan.kernels.back().kernel.name(), last_kernel) << file;
}

const Names kDiffuseMeshes = {"diffuse", "area", "triangles"};

Names with(Names names, const Names& more) {
    names.insert(more.begin(), more.end());
    return names;
}

TEST(GoldenPlan, CornellBox) {
    expect_plan(test::own_scene("cornell-box.xml"), with(kDiffuseMeshes, {"analytic_shapes"}), "diffuse, guided");
}

TEST(GoldenPlan, DoorAjar) {
    expect_plan(test::own_scene("door-ajar.xml"), with(kDiffuseMeshes, {"analytic_shapes"}), "diffuse, guided");
}

TEST(GoldenPlan, DiffuseRoom) {
    expect_plan(test::own_scene("diffuse-room.xml"),
                with(kDiffuseMeshes, {"analytic_shapes", "smooth_normals", "environment", "constant"}),
                "diffuse, guided");
}

TEST(GoldenPlan, GlossyRoom) {
    expect_plan(test::own_scene("glossy-room.xml"),
                with(kDiffuseMeshes, {"analytic_shapes", "smooth_normals", "microfacets", "coats"}),
                "general, guided, by view");
}

TEST(GoldenPlan, MixedRoom) {
    expect_plan(test::own_scene("mixed-room.xml"),
                with(kDiffuseMeshes, {"analytic_shapes", "smooth_normals", "environment", "constant", "microfacets",
                                      "coats", "delta_reflection", "transmission", "twosided"}),
                "general, guided, by view");
}

TEST(GoldenPlan, Caustic) {
    expect_plan(test::own_scene("caustic.xml"),
                with(kDiffuseMeshes, {"analytic_shapes", "smooth_normals", "microfacets", "delta_reflection",
                                      "transmission", "twosided"}),
                "general, guided, by view");
}

TEST(GoldenPlan, Features) {
    expect_plan(test::own_scene("features.xml"),
                with(kDiffuseMeshes, {"analytic_shapes", "instances", "textures",    "bitmaps",     "checkerboards",
                                      "masks",           "bump",      "normal_maps", "microfacets", "anisotropy",
                                      "coats",           "blends",    "null",        "twosided",    "textured_area",
                                      "delta_lights",    "point",     "spot",        "directional", "environment",
                                      "environment_map", "lens"}),
                "general, guided, by view");
}

TEST(GoldenPlan, WithoutWhatItForcesOffAFeatureIsNotSimulated) {
    LoadedScene loaded = load_scene(test::own_scene("features.xml"));
    Job job;
    for (const char* off : {"masks", "bump", "normal_maps", "lens", "environment", "delta_lights", "textures"})
        job.effects.off.insert(off);
    const EffectPlan plan = plan_effects(loaded.scene, job);
    EXPECT_EQ(plan.approximations.size(), 7u);
    for (const std::string& name : job.effects.off)
        EXPECT_FALSE(plan.find(name)->on) << name;
}

class SharedScene : public ::testing::Test {
  protected:
    static bool missing(const std::string& name) { return test::shared_scene(name).empty(); }
};

TEST_F(SharedScene, Cbox) {
    if (missing("cbox/cbox.xml")) GTEST_SKIP() << "no shared scenes here";
    const EffectPlan plan = planned(test::shared_scene("cbox/cbox.xml")).plan;
    const Names on = scene_effects(plan);
    EXPECT_TRUE(on.contains("area") && on.contains("diffuse"));
    EXPECT_FALSE(on.contains("microfacets") || on.contains("bitmaps") || on.contains("environment"));
    EXPECT_TRUE(plan.kernels.back().kernel.plain_diffuse);
}

TEST_F(SharedScene, Spaceship) {
    if (missing("spaceship/spaceship.xml")) GTEST_SKIP() << "no shared scenes here";
    const EffectPlan plan = planned(test::shared_scene("spaceship/spaceship.xml")).plan;
    const Names on = scene_effects(plan);
    for (const char* name : {"area", "microfacets", "coats", "transmission", "triangles"})
        EXPECT_TRUE(on.contains(name)) << name;
    for (const char* name : {"masks", "bump", "lens", "environment", "instances", "delta_lights"})
        EXPECT_FALSE(on.contains(name)) << name;
    EXPECT_FALSE(plan.kernels.back().kernel.plain_diffuse);
}

TEST_F(SharedScene, Kitchen) {
    if (missing("kitchen/kitchen-envmap-small.xml")) GTEST_SKIP() << "no shared scenes here";
    const EffectPlan plan = planned(test::shared_scene("kitchen/kitchen-envmap-small.xml")).plan;
    const Names on = scene_effects(plan);
    for (const char* name : {"environment_map", "bitmaps", "transmission", "delta_reflection", "microfacets", "coats"})
        EXPECT_TRUE(on.contains(name)) << name;
    // The file has bump maps and a mask, but shapes refer to the materials inside of the bumps, and those with the mask
    // are commented out.
    for (const char* name : {"masks", "bump", "lens", "area"})
        EXPECT_FALSE(on.contains(name)) << name;
}

}  // namespace
}  // namespace treefarm
