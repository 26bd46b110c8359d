// SPDX-License-Identifier: Apache-2.0
// integrator.hide_emitters: camera rays pass lamps in scenes of Mitsuba 2 and 3, and see black ones in those of 0.6.
#include <gtest/gtest.h>

#include "tests/support/aov_render.h"
#include "tests/support/test_scenes.h"

namespace treefarm {
namespace {

/// A wall in the light of a spot, and before it a lamp that shines at the camera; its shadow falls out of view.
Scene lamp_before_wall(bool with_lamp, bool passes) {
    Scene scene = test::wall_scene(0.25f);
    SpotEmitter spot;
    spot.position = Vec3(8, 8, 0);
    spot.axis = normalize(Vec3(-8, -8, 10));
    spot.intensity = Rgb(100.0f);
    spot.cutoff = spot.beam = 0.35f;
    scene.emitters = {{spot, {}}};
    if (with_lamp)
        test::add_shape(scene, test::quad({-1, -1, 6}, {0, 2, 0}, {2, 0, 0}), test::add_diffuse(scene, Rgb(0.5f), true),
                        Rgb(5.0f));
    scene.camera.passes_hidden_emitters = passes;
    return scene;
}

Job job_of(const char* type) {
    Job job;
    job.integrator.type = type;
    job.integrator.hide_emitters = true;
    job.integrator.max_depth = 2;
    return job;
}

/// Mean of all pixels, and of those before which the lamp is.
std::array<double, 2> means(const Scene& scene, const char* type) {
    const std::vector<PixelEstimate> image = test::render_layers(scene, "", 256, job_of(type)).pixels;
    double whole = 0, middle = 0;
    for (std::size_t p = 0; p < 64; ++p)
        whole += image[p].whole().mean.x / 64;
    for (std::size_t y = 2; y < 6; ++y)
        for (std::size_t x = 2; x < 6; ++x)
            middle += image[8 * y + x].whole().mean.x / 16;
    return {whole, middle};
}

TEST(HiddenEmitters, ArePassedByEveryEstimator) {
    for (const char* const type : {"path", "reference", "direct", "light", "bidirectional"}) {
        const auto [whole, middle] = means(lamp_before_wall(true, true), type);
        const auto [plain, plain_middle] = means(lamp_before_wall(false, true), type);
        EXPECT_GT(plain_middle, 0.001) << type;
        EXPECT_NEAR(whole, plain, 0.1 * plain) << type;
        EXPECT_NEAR(middle, plain_middle, 0.25 * plain_middle) << type;
        EXPECT_GT(means(lamp_before_wall(true, false), type)[1], 2 * plain_middle)
            << type << ": 0.6 sees the lamp's own";
    }
}

TEST(HiddenEmitters, AreInNoLayer) {
    Scene scene = lamp_before_wall(true, true);
    const auto layers = [&] { return test::render_layers(scene, "alpha,depth,shape", 8, job_of("path")); };
    EXPECT_NEAR(layers()["depth.Z"][27], 10.0f, 1e-4f);
    EXPECT_EQ(layers()["shape.I"][27], 1.0f);
    scene.camera.passes_hidden_emitters = false;
    EXPECT_NEAR(layers()["depth.Z"][27], 6.0f, 1e-4f);
    // Nothing is behind this lamp, a sphere.
    scene = lamp_before_wall(false, true);
    scene.shapes.clear();
    test::add_shape(scene, Sphere{Vec3(0, 0, 8), 1.0f}, 0, Rgb(5.0f));
    EXPECT_EQ(layers()["A"][27], 0.0f);
    scene.camera.passes_hidden_emitters = false;
    EXPECT_EQ(layers()["A"][27], 1.0f);
}

}  // namespace
}  // namespace treefarm
