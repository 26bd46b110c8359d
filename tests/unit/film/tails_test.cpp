// SPDX-License-Identifier: Apache-2.0
// Who carries an image's noise: few pixels, few samples, and where their light comes from.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <sstream>

#include "coordinator/words/noise_share.h"
#include "coordinator/words/tail_report.h"
#include "tests/support/local_render.h"
#include "tests/support/material_scenes.h"
#include "tests/support/resolved.h"
#include "worker/integrators/path/observe_sample.h"
#include "worker/integrators/path/origin_finder.h"

namespace treefarm {
namespace {

TEST(TailSamples, AreTheSameInAnyOrder) {
    std::mt19937 engine(3);
    std::vector<TailSample> samples;
    for (std::uint32_t i = 0; i < 60; ++i)
        samples.push_back({static_cast<float>(1 + engine() % 12),
                           i % 2,
                           static_cast<std::uint16_t>(engine() % 4),
                           static_cast<std::uint16_t>(engine() % 4),
                           i,
                           {}});
    std::vector<TailSample> sorted = samples;
    std::sort(sorted.begin(), sorted.end(), comes_before);
    sorted.resize(TailSamples::kMost);
    for (int trial = 0; trial < 20; ++trial) {
        std::shuffle(samples.begin(), samples.end(), engine);
        TailSamples parts[5], halves[2], whole;
        for (std::size_t i = 0; i < samples.size(); ++i)
            parts[engine() % 5].add(samples[i]);
        for (int p = 0; p < 5; ++p)
            halves[p % 2].add(parts[p]);
        whole.add(halves[1]);
        whole.add(halves[0]);
        EXPECT_EQ(whole.worst, sorted);
    }
}

float noise_of(const std::vector<float>& values, std::uint32_t spp = 0) {
    Moments pixel;
    for (const float value : values)
        pixel.add(Rgb(value));
    return outlier_noise(Rgb(*std::max_element(values.begin(), values.end())), pixel,
                         spp ? spp : static_cast<std::uint32_t>(values.size()));
}

TEST(TailSamples, NoiseIsWhatOneSampleAddsToTheVarianceOfTheMean) {
    EXPECT_NEAR(noise_of({1, 1, 1, 9}), 3.0f, 1e-5f) << "(9 - 3)^2 / (4 * 3), of 48 / (4 * 3) in all";
    EXPECT_NEAR(noise_of({1, 1, 1, 9}, 8), 36.0f / 56, 1e-5f) << "half of the pixel's samples";
    EXPECT_EQ(noise_of({7, 7, 7, 7}), 0.0f) << "a lamp that is seen directly";
    EXPECT_EQ(noise_of({0, 2, 0, 2, 0, 2, 0, 2}), 0.0f) << "none is to blame";
    EXPECT_EQ(noise_of({5}), 0.0f);
}

TEST(NoiseShare, IsThatOfTheFewestPixels) {
    std::vector<Rgb64> variance(1000, Rgb64(1.0));
    EXPECT_NEAR(noise_share(variance, 0.4).value(), 0.4, 1.1e-3);
    EXPECT_NEAR(noise_share(variance, 0.999).value(), 0.999, 1.1e-3);
    for (std::size_t p = 5; p < 1000; p += 100)
        variance[p] = Rgb64(100.0);
    EXPECT_EQ(noise_share(variance, 0.4).value(), 0.008) << "796 of 1990";
    EXPECT_EQ(noise_share(variance, 1e-9).value(), 0.001);
    EXPECT_FALSE(noise_share(std::vector<Rgb64>(9, Rgb64(0.0)), 0.4));
    EXPECT_FALSE(noise_share({}, 0.4));
}

TEST(LightOrigin, InWordsThatTellThemApart) {
    EXPECT_EQ(words(LightOrigin{LightFound::met, PathClass::rough_glass, 4}),
              "light through rough glass, met by chance");
    EXPECT_EQ(words(LightOrigin{LightFound::sampled, PathClass::mirror, 3}), "light in mirrors, sampled by next event");
    EXPECT_EQ(words(LightOrigin{LightFound::sky_met, PathClass::diffuse, 1}),
              "light of the environment that the camera sees");
    std::set<std::string> texts;
    for (std::uint8_t found = 0; found < 4; ++found)
        for (std::uint8_t path_class = 0; path_class < 6; ++path_class) {
            const LightOrigin origin{static_cast<LightFound>(found), static_cast<PathClass>(path_class), 2};
            EXPECT_TRUE(is_known(origin));
            texts.insert(words(origin));
        }
    EXPECT_EQ(texts.size(), 24u);
}

constexpr SurfacePassage kDiffuse{PathClass::diffuse, false}, kGlossy{PathClass::glossy, false},
    kGlass{PathClass::smooth_glass, true}, kRoughGlass{PathClass::rough_glass, false};

/// A finder that has been told of a camera's ray along +z, and of a surface that faces it.
struct Told : OriginFinder {
    Told() {
        camera({Vec3(0.0f), Vec3(0, 0, 1)});
        hit.ng = Vec3(0, 0, -1);
        arrive(1, &hit);
    }
    void pass(const SurfacePassage& surface) { scatter(surface, {}, Rgb(1.0f)); }
    void shine(float light) { emission(Rgb(light), 1.0f, 1.0f, Rgb(light)); }

    Hit hit;
};

TEST(OriginFinder, WhatTheCameraLooksThroughCountsOnlyIfNothingScattersBehind) {
    Told told;
    told.pass(kGlass);
    told.arrive(2, &told.hit);
    told.shine(1.0f);
    EXPECT_EQ(told.origin(), (LightOrigin{LightFound::met, PathClass::smooth_glass, 2}));
    told.next_event(kDiffuse, {Vec3(0, 0, 1), 1.0f, 1.0f, false}, 1.0f, 1.0f, Rgb(2.0f));
    EXPECT_EQ(told.origin(), (LightOrigin{LightFound::sampled, PathClass::diffuse, 3}));
    told.pass(kDiffuse);
    told.pass(kGlass);
    told.arrive(3, nullptr);
    told.shine(3.0f);
    EXPECT_EQ(told.origin(), (LightOrigin{LightFound::sky_met, PathClass::smooth_glass, 3}));
    told.shine(0.5f);
    EXPECT_EQ(told.origin().vertices, 3) << "the largest contribution counts";
}

TEST(OriginFinder, SplitPathsGoOnFromWhereTheyWereLeft) {
    Told told;
    told.pass(kDiffuse);
    told.arrive(2, &told.hit);
    told.split(3, Rgb(1.0f));
    told.pass(kRoughGlass);
    told.arrive(3, &told.hit);
    told.split(2, Rgb(1.0f));
    told.shine(1.0f);
    EXPECT_EQ(told.origin().path_class, PathClass::rough_glass);
    const auto go_on = [&](const SurfacePassage& surface, float light) {
        told.split_path({});
        told.arrive(3, &told.hit);
        told.pass(surface);
        told.arrive(4, &told.hit);
        told.shine(light);
        return told.origin().path_class;
    };
    EXPECT_EQ(go_on(kDiffuse, 2.0f), PathClass::diffuse);
    EXPECT_EQ(go_on(kGlossy, 3.0f), PathClass::glossy);
    EXPECT_EQ(go_on(kDiffuse, 4.0f), PathClass::rough_glass) << "left behind the glass";
}

TEST(OriginFinder, TheOtherBranchOutOfGlassBeginsAtIt) {
    Told told;
    told.pass(kGlass);
    for (const float z : {1.0f, -1.0f}) {
        told.other_branch({Vec3(0.0f), Vec3(0, 0, z)}, Rgb(1.0f));
        told.arrive(2, nullptr);
        told.shine(2.0f - z);
        EXPECT_EQ(told.origin().path_class, z > 0 ? PathClass::smooth_glass : PathClass::mirror);
    }
}

/// A room with a lamp below its ceiling, and a small bright one in a ball of glass that the camera does not see.
Scene lamp_in_glass(const Roughness& roughness) {
    Scene scene;
    const std::int32_t wall = test::add_diffuse(scene, Rgb(0.5f));
    const std::int32_t glass = test::add_material(scene, DielectricMaterial{1.5f, Rgb(1.0f), Rgb(1.0f), roughness});
    const Vec3 at(0.4f, -0.4f, -0.5f);
    test::add_shape(scene, test::box(Vec3(-1.0f), Vec3(1.0f), true), wall);
    test::add_shape(scene, test::quad({-0.3f, 0.99f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}), wall, Rgb(5.0f));
    test::add_shape(scene, Sphere{at, 0.2f}, glass);
    test::add_shape(scene, Sphere{at, 0.05f}, wall, Rgb(1000.0f));
    scene.camera = test::look_at(Vec3(0.0f), {0, 0, 1}, {0, 1, 0}, 1.0f);
    test::set_film(scene, 16, 32);
    return scene;
}

/// A render of eight tiles, each of which has a firefly.
class Fireflies : public testing::TestWithParam<GuidingType> {
  protected:
    static Job job() {
        Job job;
        job.guiding.type = GetParam();
        job.guiding.spatial_threshold = 200;
        job.integrator.max_depth = 8;
        job.budget.spp = 31;
        job.farm.tile_size = 8;
        return job;
    }
};

TEST_P(Fireflies, AreNamed) {
    for (const bool rough : {false, true}) {
        const Scene scene = lamp_in_glass(rough ? test::rough(Microfacets::ggx, 0.2f, 0.2f) : Roughness());
        const test::LocalRender run = test::render_locally(scene, job());
        ASSERT_EQ(run.stats.size(), run.plans.size());
        for (std::size_t k = 0; k < run.stats.size(); ++k) {
            if (run.plans[k].spp < 4) continue;  // of two samples none is an outlier
            // What is not the same when it is traced again is not told.
            EXPECT_EQ(run.stats[k].tails.worst.size(), 8u) << run.plans[k].kernel.name() << ", pass " << k;
        }
        ASSERT_FALSE(run.stats.back().tails.worst.empty());
        const std::string name = words(run.stats.back().tails.worst[0].origin);
        if (rough)
            EXPECT_NE(name.find("through rough glass"), std::string::npos) << name;
        else
            EXPECT_EQ(name, "light through smooth glass, met by chance");
    }
}

TEST_P(Fireflies, CanBeTracedAgain) {
    const Scene scene = lamp_in_glass({});
    const test::LocalRender run = test::render_locally(scene, job());
    const Resolved resolved = resolve(job(), scene);
    const TraceScene trace(scene, resolved);
    const PassPlan& pass = run.plans.back();
    const AnySampler guide(run.model);
    ASSERT_FALSE(run.stats.back().tails.worst.empty());
    for (const TailSample& sample : run.stats.back().tails.worst) {
        OriginFinder finder;
        const Rgb radiance = observe_sample(trace, resolved, pass, guide, sample.x, sample.y, sample.sample, finder);
        EXPECT_EQ(finder.origin(), sample.origin);
        const PixelEstimate& pixel = run.passes.back().pixels[sample.y * std::size_t{16} + sample.x];
        EXPECT_EQ(outlier_noise(radiance, pixel.whole(), pass.spp), sample.noise);
        std::ostringstream text;
        text.precision(9);
        text << ": radiance (" << radiance.x << ", " << radiance.y << ", " << radiance.z << ")\n";
        EXPECT_NE(describe_sample(trace, resolved, pass, guide, sample.x, sample.y, sample.sample).find(text.str()),
                  std::string::npos);
    }
}

INSTANTIATE_TEST_SUITE_P(Guides, Fireflies,
                         testing::Values(GuidingType::none, GuidingType::ppg, GuidingType::automatic));

/// An image of which three pixels have nearly all noise, after three passes of which the last two count.
struct Tailed {
    CombinedImage image;
    std::vector<PassReport> passes;

    explicit Tailed(std::size_t quiet) : passes(3) {
        image.variance.assign(quiet, Rgb64(1e-6));
        image.variance.resize(quiet + 3, Rgb64(1.0));
        image.longest_pass = 4;
        image.weight = {0.25, 0.75};
        passes[0].stats.tails.add({100.0f, 0, 1, 1, 1, {}});
        passes[1].stats.tails.add({8.0f, 1, 2, 2, 2, {LightFound::sampled, PathClass::mirror, 3}});
        passes[2].stats.tails.add({2.0f, 2, 120, 44, 61, {LightFound::met, PathClass::rough_glass, 4}});
    }
};

TEST(TailReport, NamesWhatMostNoiseComesFrom) {
    const Tailed tailed(10000);
    const TailReport report = tail_report(tailed.image, tailed.passes);
    EXPECT_TRUE(report.stands_out);
    EXPECT_EQ(report.share.value(), 2.0 / 10003);
    ASSERT_EQ(report.worst.worst.size(), 2u);
    EXPECT_EQ(report.worst.worst[0].noise, 2.0f * 0.5625f) << "in the image";
    EXPECT_EQ(report.worst.worst[1].noise, 8.0f * 0.0625f);
    EXPECT_EQ(tail_text(report),
              "fireflies: 40 % of the noise is in 0.02 % of the pixels (light through rough glass, met by chance)");
    EXPECT_EQ(tail_command(report, "treefarm render x.xml --debug-sample", " --run-dir r"),
              "the worst firefly, pixel (120, 44), vertex by vertex: treefarm render x.xml --debug-sample 3,120,44,61 "
              "--run-dir r");
}

TEST(TailReport, WhatTheCameraSeesDirectlyIsNoFirefly) {
    Tailed lamp(10000);
    lamp.passes[2].stats.tails.add({5.0f, 2, 132, 25, 7, {LightFound::met, PathClass::diffuse, 1}});
    const TailReport mostly_lamp = tail_report(lamp.image, lamp.passes);
    EXPECT_FALSE(mostly_lamp.stands_out) << "most noise is that of a lamp's edge";
    ASSERT_EQ(mostly_lamp.worst.worst.size(), 3u);
    EXPECT_EQ(mostly_lamp.worst.worst[0].x, 132) << "the worst of all is the same for every split into tiles";
    EXPECT_NE(tail_command(mostly_lamp, "", "").find("pixel (120, 44)"), std::string::npos);
    EXPECT_EQ(mostly_lamp.origin, "light through rough glass, met by chance");
    Tailed sky(10000);
    sky.passes[2].stats.tails.add({0.5f, 2, 132, 25, 7, {LightFound::sky_met, PathClass::diffuse, 1}});
    EXPECT_TRUE(tail_report(sky.image, sky.passes).stands_out);
}

TEST(TailReport, IsSilentWhereThereIsNothingToSay) {
    const Tailed small(100);
    EXPECT_FALSE(tail_report(small.image, small.passes).stands_out);
    Tailed even(10000);
    even.image.variance.assign(10000, Rgb64(1.0));
    EXPECT_FALSE(tail_report(even.image, even.passes).stands_out);
    EXPECT_FALSE(tail_report({}, {}).share);
}

}  // namespace
}  // namespace treefarm
