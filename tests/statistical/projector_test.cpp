// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "common/base/random.h"
#include "common/plan/resolve/resolve.h"
#include "tests/support/light_checks.h"
#include "tests/support/material_scenes.h"
#include "tests/support/test_scenes.h"
#include "worker/scene/trace_scene.h"

namespace treefarm {
namespace {

using test::expect_irradiance;

const Vec3 kUpwards(0, 0, 1);

/// With something small in it, so that the scene has a size.
Scene lit_by_projector(const ProjectorEmitter& projector) {
    Scene scene;
    test::add_shape(scene, test::quad({-1, -1, -2}, {2, 0, 0}, {0, 2, 0}), kNone);
    scene.emitters.push_back({projector, {}});
    return scene;
}

/// A picture of 4 x 2 numbered texels, thrown down from z = 2 with u along -x and v along y.
struct Projection {
    static constexpr int kColumns = 4, kRows = 2;
    static constexpr float kHeight = 2.0f;
    ProjectorEmitter projector{Vec3(1, -2, kHeight),    Vec3(0, 0, -1), Vec3(-1, 0, 0), Vec3(0, 1, 0), 0.6f, 0.3f,
                               ColorInput(Rgb(5.0f), 0)};
    Scene scene = lit_by_projector(projector);

    Projection() {
        TextureImage image;
        image.width = kColumns, image.height = kRows, image.channels = 1;
        for (int i = 0; i < kColumns * kRows; ++i)
            image.floats.push_back(1.0f + float(i));
        scene.images.push_back(image);
        test::add_texture(scene, BitmapTexture{0, false, Wrap::repeat, Wrap::repeat, {}}, "");
    }
    /// Place on the plane z = 0 where this point of the picture falls.
    Vec3 point(float u, float v) const {
        return {projector.position.x - kHeight * projector.half_width * (2 * u - 1),
                projector.position.y + kHeight * projector.half_height * (2 * v - 1), 0.0f};
    }
    static double texel(float u, float v) { return 1.0 + int(v * kRows) * kColumns + int(u * kColumns); }
};

TEST(Projector, ThrowsItsPicture) {
    const Projection thrown;
    for (const float v : {0.01f, 0.3f, 0.7f, 0.99f})
        for (const float u : {0.01f, 0.3f, 0.6f, 0.8f, 0.99f})
            expect_irradiance(thrown.scene, thrown.point(u, v), kUpwards, 5.0 * Projection::texel(u, v) / 4.0,
                              "place " + std::to_string(u) + ", " + std::to_string(v));
    for (const auto& [u, v] : {std::pair{-0.01f, 0.5f}, {1.01f, 0.5f}, {0.5f, -0.01f}, {0.5f, 1.01f}})
        expect_irradiance(thrown.scene, thrown.point(u, v), kUpwards, 0.0, "beside the picture");
    // Behind it, where the picture would be if lines went on.
    const Vec3 behind = thrown.projector.position * 2.0f - thrown.point(0.3f, 0.3f);
    expect_irradiance(thrown.scene, behind, Vec3(0, 0, -1), 0.0, "behind");
    // Without a texture, on a tilted surface at other distances: E cos / (z^2 cos_axis).
    ProjectorEmitter plain = thrown.projector;
    plain.irradiance.texture = kNone;
    const Vec3 n = normalize(Vec3(0.4f, -0.3f, 1));
    for (const double scale : {1e-4, 1.0, 1e5}) {
        plain.position = Vec3(0, 0, static_cast<float>(scale));
        const Vec3 p = Vec3(0.5f, 0.2f, 0.0f) * static_cast<float>(scale);
        const Vec3 wi = normalize(plain.position - p);
        expect_irradiance(lit_by_projector(plain), p, n, 5.0 * double(dot(n, wi)) / (scale * scale * double(wi.z)),
                          "scale " + std::to_string(scale));
    }
}

/// The probability that it is chosen is its share of the power, which is what crosses the plane: a sample's pdf.
TEST(Projector, IsChosenByWhatItThrows) {
    Projection thrown;
    thrown.scene.emitters.push_back({PointEmitter{Vec3(5, 5, 5), Rgb(2.0f)}, {}});
    Job job;
    job.integrator.light_selection = LightSelection::power;
    const TraceScene lights(thrown.scene, resolve(job, thrown.scene));
    // Means of cells of equal area, at distance 1: 4 * 0.6 * 0.3 m^2 under 5 times the mean of 1 to 8.
    const double watts = 4 * 0.6 * 0.3 * 5 * 4.5, other = 4 * M_PI * 2, expected = watts / (watts + other);
    const Vec3 p = thrown.point(0.3f, 0.3f);
    constexpr std::uint32_t kSamples = 100000;
    double count = 0;
    for (std::uint32_t i = 0; i < kSamples; ++i) {
        const DirectSample s = lights.emitters().sample_direct(p, draw({6, i, 0}, 1, Stream::light));
        ASSERT_TRUE(s.delta);
        const bool by_projector = s.on_light.p == thrown.projector.position;
        ASSERT_NEAR(s.pdf, by_projector ? expected : 1 - expected, 1e-5);
        count += by_projector;
    }
    EXPECT_NEAR(count / kSamples, expected, 4.5 * std::sqrt(expected * (1 - expected) / kSamples));
    Hit hit;
    hit.shape = 0;
    EXPECT_EQ(lights.emitters().pdf_direct(p, kUpwards, hit), 0.0f) << "nothing but sampling finds it";
}

}  // namespace
}  // namespace treefarm
