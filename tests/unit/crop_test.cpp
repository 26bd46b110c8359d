// SPDX-License-Identifier: Apache-2.0
// Crop windows: their pixels are those of the whole film, bit for bit.
#include <gtest/gtest.h>

#include "common/film/guiding_probe.h"
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

TEST(Crop, ProbesOfGuidingAreTheSamePixelsForWorkerAndFilm) {
    Job job;
    job.guiding.type = GuidingType::automatic;
    job.budget.spp = 127;
    const test::LocalRender run = test::render_locally(cropped_box(), job);
    std::size_t probed = 0;
    for (std::size_t p = 0; p < run.stats.size(); ++p) {
        if (run.stats[p].probe_paths == 0) continue;
        ++probed;
        const ProbePixels probe(77, static_cast<std::uint32_t>(p));
        std::uint64_t paths = 0;
        for (std::uint32_t pixel = 0; pixel < 77; ++pixel)
            paths += probe.holds(pixel) ? run.states[p].passes.back().spp : 0;
        EXPECT_EQ(run.stats[p].probe_paths, paths) << p;
    }
    EXPECT_GT(probed, 0u);
}

}  // namespace
}  // namespace treefarm
