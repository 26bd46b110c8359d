// SPDX-License-Identifier: Apache-2.0
// guiding.type "auto" finds out whether guiding pays, and either answer leaves the image as it is.
#include "common/film/guiding_probe.h"

#include <gtest/gtest.h>

#include "common/config/job.h"
#include "common/scene/readers/load.h"
#include "tests/support/local_render.h"
#include "tests/support/material_scenes.h"
#include "tests/support/support.h"
#include "tests/support/test_scenes.h"

namespace treefarm {
namespace {

Job automatic_job(std::uint32_t spp) {
    Job job;
    job.guiding.type = GuidingType::automatic;
    job.guiding.combination = Combination::fixed;
    job.guiding.spatial_threshold = 1000;
    job.integrator.max_depth = 6;
    job.budget.spp = spp;
    job.sampler.seed = 4;
    return job;
}

TEST(GuidingProbe, GuidingGoesOnWhereItPays) {
    Scene scene = load_scene(test::own_scene("door-ajar.xml"), {}, false).scene;
    scene.film.width = scene.film.height = 64;
    const test::LocalRender run = test::render_locally(scene, automatic_job(127));
    ASSERT_FALSE(run.guiding_gains.empty());
    EXPECT_GT(run.guiding_gains.back(), 1.0);
    EXPECT_EQ(run.states.back().guiding, Guiding::pays);
    for (std::size_t k = 0; k < run.stats.size(); ++k)
        EXPECT_EQ(run.stats[k].probe_paths > 0, run.passes[k].spp == 4) << "unguided samples hardly find its light";
}

/// In a closed furnace all paths of the same length carry the same: nothing is gained by a tree.
TEST(GuidingProbe, GuidingEndsWhereItDoesNotPay) {
    Scene scene = test::furnace(0.5f, 1.0f, 2.0f, Vec3(0.3f, -0.2f, 0.1f));
    test::set_film(scene, 32, 32);
    Job job = automatic_job(127);
    job.integrator.rr_depth = 100;
    job.integrator.next_event = NextEvent::never;
    const test::LocalRender run = test::render_locally(scene, job);
    ASSERT_FALSE(run.guiding_gains.empty());
    EXPECT_LT(run.guiding_gains.back(), 0.1);
    EXPECT_EQ(run.states.back().guiding, Guiding::loses);
    EXPECT_EQ(run.guiding_gains.size(), 3u) << "passes of 1 to 4 spp; nobody asks again";
    for (const PassResult& pass : run.passes)
        for (const PixelEstimate& pixel : pass.pixels)
            ASSERT_EQ(pixel.whole().n, pass.spp) << "what probed is as good as the rest, and was put back";

    job.guiding.type = GuidingType::none;
    job.sampler.seed = 5;
    const test::LocalRender unguided = test::render_locally(scene, job);
    double sum = 0, variance = 0;
    for (std::size_t p = 0; p < run.image.mean.size(); ++p) {
        sum += run.image.mean[p].y - unguided.image.mean[p].y;
        variance += run.image.variance[p].y + unguided.image.variance[p].y;
    }
    EXPECT_LT(std::abs(sum), 4 * std::sqrt(variance) + 1e-3);
}

TEST(GuidingProbe, ProbePixelsAreUnguided) {
    Scene scene = load_scene(test::own_scene("features.xml"), {}, false).scene;
    scene.film.width = scene.film.height = 64;
    Job job = automatic_job(127);
    const test::LocalRender run = test::render_locally(scene, job);
    int probes = 0;
    for (std::size_t k = 0; k < run.stats.size(); ++k) {
        const ProbePixels probe(64 * 64, static_cast<std::uint32_t>(k));
        std::uint64_t expected = 0;
        for (std::uint32_t p = 0; p < 64 * 64; ++p)
            expected += probe.holds(p);
        const bool probed = run.stats[k].probe_paths != 0;
        probes += probed;
        EXPECT_EQ(probed, run.passes[k].spp >= 4 && run.passes[k].spp <= 16);
        EXPECT_EQ(run.stats[k].probe_paths, probed ? expected * run.passes[k].spp : 0);
        EXPECT_EQ(run.stats[k].probe_rays > run.stats[k].probe_paths, probed);
        for (std::uint32_t p = 0; p < 64 * 64; ++p)
            EXPECT_EQ(run.passes[k].pixels[p].whole().n, probed && probe.holds(p) ? 0 : run.passes[k].spp);
    }
    EXPECT_EQ(probes, 3) << "those of 4, 8 and 16 spp";
}

}  // namespace
}  // namespace treefarm
