// SPDX-License-Identifier: Apache-2.0
// What the worker is told of the plan: its kernels, and the effects of a scene.
#include "common/plan/effects/scene_effects.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/test_scenes.h"
#include "worker/integrators/path/tile_renderer.h"

namespace treefarm {
namespace {

TEST(Kernels, AreThoseThatThePlanNamesAndAtMostTwelve) {
    const std::vector<KernelChoice> compiled = compiled_kernels(GuideKind::sd_tree);
    EXPECT_LE(compiled.size(), 12u);
    for (const bool diffuse : {false, true})
        for (const bool guided : {false, true})
            for (const bool record : {false, true}) {
                const KernelChoice choice{diffuse, guided, record};
                EXPECT_EQ(std::count(compiled.begin(), compiled.end(), choice), 1) << choice.name();
                const KernelChoice by_view{diffuse, guided, record, true};
                EXPECT_EQ(std::count(compiled.begin(), compiled.end(), by_view), !diffuse && (guided || record))
                    << by_view.name();
            }
}

/// A guide has kernels of its own for what guides or records; whether for plainly diffuse scenes it says itself.
TEST(Kernels, OfEveryGuideAreThoseThatPassesAskFor) {
    const std::size_t unguided = 2;
    std::size_t all = unguided;
    int kind = 0;
    Guides::find([&]<class G>() {
        const std::vector<KernelChoice> compiled = compiled_kernels(static_cast<GuideKind>(kind++));
        EXPECT_EQ(compiled.size(), unguided + G::kKernels);
        all += G::kKernels;
        for (const bool diffuse : {false, true})
            for (const bool trained : {false, true})
                for (const bool record : {false, true}) {
                    PassPlan pass;
                    pass.guided = trained;
                    pass.record = record;
                    Resolved job;
                    job.scene_facts.plainly_diffuse = diffuse;
                    const KernelChoice choice = kernel_of(job, pass, {trained, false, G::kPlainKernels});
                    EXPECT_EQ(std::count(compiled.begin(), compiled.end(), choice), 1) << choice.name();
                }
        return false;
    });
    EXPECT_EQ(all, std::size_t(kKernelCount)) << "what the plan says that the program has";
}

/// A masked pane before a camera with a lens, under a constant sky.
Scene scene_with_effects() {
    Scene scene;
    scene.film.width = scene.film.height = 2;
    const std::int32_t material = test::add_diffuse(scene, Rgb(0.5f));
    scene.materials[0].opacity = FloatInput(0.5f);
    scene.materials[0].where = {"pane.xml", 7, 3};
    test::add_shape(scene, test::quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), material);
    scene.emitters.push_back({ConstantEmitter{Rgb(1.0f)}, {}});
    scene.camera.lens_u = Vec3(0.1f, 0.0f, 0.0f);
    scene.camera.lens_v = Vec3(0.0f, 0.1f, 0.0f);
    return scene;
}

TEST(SceneEffects, AreThoseOfThePlan) {
    const SceneEffects on = find_scene_effects(scene_with_effects(), Job());
    EXPECT_TRUE(on.masks && on.environment && on.lens);
    EXPECT_FALSE(on.textures || on.bump || on.anisotropy || on.transmission);

    Scene scene = scene_with_effects();
    scene.materials[0].opacity = FloatInput(1.0f);
    scene.materials[0].bsdf = DielectricMaterial{};
    scene.emitters.clear();
    scene.camera.lens_u = scene.camera.lens_v = Vec3(0.0f);
    const SceneEffects glass = find_scene_effects(scene, Job());
    EXPECT_TRUE(glass.transmission);
    EXPECT_FALSE(glass.masks || glass.environment || glass.lens);
}

}  // namespace
}  // namespace treefarm
