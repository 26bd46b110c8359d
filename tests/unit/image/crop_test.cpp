// SPDX-License-Identifier: Apache-2.0
// Crop windows: their pixels are those of the whole film, bit for bit.
#include <gtest/gtest.h>

#include "tests/support/local_render.h"
#include "tests/support/test_scenes.h"

namespace treefarm {
namespace {

Scene small_box() {
    Scene scene = test::cornell_box(1.0f, Vec3(0.0f));
    scene.film = {24, 16, PixelFilter::gaussian, 2.0f, 0.5f};
    return scene;
}

Scene cropped_box() {
    Scene scene = small_box();
    scene.film.crop = {9, 3, scene.film.width, scene.film.height};
    scene.film.width = 11;
    scene.film.height = 7;
    return scene;
}

TEST(Crop, PixelsEqualThoseOfTheWholeFilm) {
    Job job;
    job.guiding.type = GuidingType::none;
    job.budget.spp = 6;
    job.farm.tile_size = 4;
    const test::LocalRender whole = test::render_locally(small_box(), job),
                            part = test::render_locally(cropped_box(), job);
    ASSERT_EQ(part.image.mean.size(), 77u);
    for (std::size_t y = 0; y < 7; ++y)
        for (std::size_t x = 0; x < 11; ++x) {
            const std::size_t there = (y + 3) * 24 + x + 9;
            EXPECT_EQ(part.image.mean[y * 11 + x], whole.image.mean[there]) << x << ", " << y;
            EXPECT_EQ(part.image.variance[y * 11 + x], whole.image.variance[there]);
            EXPECT_EQ(part.image.half[1][y * 11 + x], whole.image.half[1][there]);
        }
}

/// What guided samples add up to by groups of pixels is what the film holds of these pixels: in a grey scene, where the
/// luminance's second moment is that of any channel.
TEST(Crop, GroupsOfPixelsAreTheSameForWorkerAndFilm) {
    Scene scene = test::furnace(0.5f, 1.0f, 2.0f, Vec3(0.3f, -0.2f, 0.1f));
    scene.film = cropped_box().film;
    Job job;
    job.guiding.type = GuidingType::automatic;
    job.integrator.rr_depth = 1;
    job.budget.spp = 31;
    job.farm.tile_size = 4;
    const test::LocalRender run = test::render_locally(scene, job);
    const PassPlan& plan = run.plans[1];
    ASSERT_TRUE(plan.guided && plan.record);
    const Rgb64 first = run.passes[0].pixels[0].whole().mean;
    std::array<double, UnguidedSums::kGroups> film{};
    double levels = 0;  // their mean; that of a block differs by its noise
    for (const PixelEstimate& pixel : run.passes[0].pixels)
        levels += pixel.whole().mean.y / 77;
    ASSERT_GT(levels, 0.5 * first.y);
    for (std::uint32_t p = 0; p < 77; ++p) {
        const Moments m = run.passes[1].pixels[p].whole();
        film[pixel_group(p % 11, p / 11)] += (m.m2.y + m.n * m.mean.y * m.mean.y) / (levels * levels);
    }
    const UnguidedSums& sums = run.stats[1].sums<UnguidedSums>();
    for (std::size_t g = 0; g < film.size(); ++g)
        EXPECT_NEAR(static_cast<double>(sums.guided[g]) * UnguidedSums::kMomentUnit, film[g], 0.35 * film[g] + 1e-6)
            << g;
}

}  // namespace
}  // namespace treefarm
