// SPDX-License-Identifier: Apache-2.0
// The quantum of a scene's splats: about a millionth of what a light path brings to the film.
#include "common/plan/resolve/splat_quantum.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/plan/resolve/resolve.h"
#include "common/plan/schedule/schedule.h"
#include "tests/support/test_scenes.h"

namespace treefarm {
namespace {

/// A floor of albedo 0.5 below a camera that sees all of it, and no light yet.
Scene floor_scene(float scale) {
    Scene scene;
    test::add_shape(scene, test::quad(Vec3(-1, 0, -1) * scale, Vec3(0, 0, 2) * scale, Vec3(2, 0, 0) * scale),
                    test::add_diffuse(scene, Rgb(0.5f)));
    scene.camera = test::look_at(Vec3(0, 4, 0) * scale, Vec3(0.0f), Vec3(0, 0, 1), 0.25f);
    test::set_film(scene, 16, 16);
    return scene;
}

/// Whether the floor's radiance, of which its splats are about, has some twenty bits.
void expect_bits(const Scene& scene, double radiance, const std::string& what) {
    const double bits = std::log2(radiance) - usual_splat_exponent(scene);
    EXPECT_GT(bits, 14) << what;
    EXPECT_LT(bits, 26) << what;
}

TEST(SplatQuantum, FollowsLightScaleAndKind) {
    for (const float scale : {1e-3f, 1.0f, 1e4f})
        for (const float bright : {1e-6f, 1.0f, 1e6f}) {
            const std::string what = std::to_string(scale) + " " + std::to_string(bright);
            const double b = double(bright), s2 = double(scale) * double(scale);
            Scene lamp = floor_scene(scale);
            test::add_shape(lamp, Sphere{Vec3(0, 2, 0) * scale, 0.01f * scale, false}, kNone, Rgb(bright));
            expect_bits(lamp, 0.5 / M_PI * b * M_PI * 1e-4 / 4, "lamp " + what);
            Scene point = floor_scene(scale);
            point.emitters.push_back({PointEmitter{Vec3(0, 2, 0) * scale, Rgb(bright)}, {}});
            expect_bits(point, 0.5 / M_PI * b / (4 * s2), "point " + what);
            Scene sun = floor_scene(scale);
            sun.emitters.push_back({DirectionalEmitter{Vec3(0, -1, 0), Rgb(bright)}, {}});
            expect_bits(sun, 0.5 / M_PI * b, "sun " + what);
            Scene sky = floor_scene(scale);
            sky.emitters.push_back({ConstantEmitter{Rgb(bright)}, {}});
            expect_bits(sky, 0.5 * b, "sky " + what);
        }
    EXPECT_EQ(usual_splat_exponent(floor_scene(1.0f)), 0);
    EXPECT_EQ(usual_splat_exponent(Scene()), 0);
}

/// Passes of an estimator that walks from the lights are ranges of paths on a film of splats; others are as they were.
TEST(SplatQuantum, IsThatOfEveryPass) {
    Scene scene = floor_scene(1.0f);
    scene.emitters.push_back({ConstantEmitter{Rgb(1.0f)}, {}});
    Job job;
    job.budget.spp = 28;
    for (const PassPlan& pass : plan_passes(resolve(job, scene))) {
        EXPECT_EQ(pass.units, PassUnits{});
        EXPECT_EQ(pass.layers, PassLayers{});
    }
    job.integrator.type = "light";
    std::uint32_t done = 0;
    for (const PassPlan& pass : plan_passes(resolve(job, scene))) {
        EXPECT_EQ(pass.units, (PassUnits{.tiles = false, .light_paths = pass.spp, .first_light_path = done}));
        EXPECT_EQ(pass.layers, (PassLayers{.estimates = false, .splats = {256, usual_splat_exponent(scene)}}));
        done += pass.spp;
    }
    EXPECT_EQ(done, 28u);
}

}  // namespace
}  // namespace treefarm
