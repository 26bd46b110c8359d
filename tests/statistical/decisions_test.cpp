// SPDX-License-Identifier: Apache-2.0
// What is decided on guiding and on next event, and that no decision changes what the image is of.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <tuple>

#include "common/config/job_reader.h"
#include "common/decide/guiding/guiding_constants.h"
#include "common/decide/next_event/next_event_constants.h"
#include "common/decide/pixels/image_levels.h"
#include "common/metrics/z_test.h"
#include "coordinator/input/load.h"
#include "tests/support/local_render.h"
#include "tests/support/material_scenes.h"
#include "tests/support/rendered.h"
#include "tests/support/support.h"
#include "tests/support/test_scenes.h"

namespace treefarm {
namespace {

using test::Rendered;

Job automatic_job(std::uint32_t spp) {
    Job job;
    job.guiding.type = GuidingType::automatic;
    job.guiding.spatial_threshold = 1000;
    job.integrator.max_depth = 6;
    job.budget.spp = spp;
    job.sampler.seed = 4;
    return job;
}

void expect_same(const Rendered& a, const Rendered& b) {
    ZTestOptions options;
    options.block = 8;
    const BlockZTest blocks = block_z_test({a.mean, b.mean, &a.variance, &b.variance}, options);
    EXPECT_TRUE(blocks.pass) << "worst block z " << blocks.max_abs_z << " of " << blocks.limit;
    EXPECT_LT(blocks.mean_z2, 2.0);
    for (const double z : blocks.image_z)
        EXPECT_LT(std::abs(z), 4.0);
}

TEST(Guided, GoesOnWhereItPays) {
    Scene scene = load_scene(test::own_scene("door-ajar.xml"), {}, false).scene;
    scene.film.width = scene.film.height = 64;
    const test::LocalRender run = test::render_locally(scene, automatic_job(127));
    const PassReport& last = run.reports[run.reports.size() - 2];  // the last that taught
    EXPECT_GT(last.decisions.get<GuidingVerdict>().efficiency.low(), 1.0);
    EXPECT_TRUE(run.plans.back().guided);
}

/// In a closed furnace all paths of the same length carry the same: nothing is gained by a tree.
TEST(Guided, EndsWhereItDoesNotPay) {
    Scene scene = test::furnace(0.5f, 1.0f, 2.0f, Vec3(0.3f, -0.2f, 0.1f));
    test::set_film(scene, 32, 32);
    Job job = automatic_job(127);
    job.guiding.combination = Combination::fixed;
    job.integrator.rr_depth = 100;
    job.integrator.next_event = NextEvent::never;
    const test::LocalRender run = test::render_locally(scene, job);
    EXPECT_FALSE(run.plans.back().guided);
    const PassReport* told = nullptr;
    for (const PassReport& report : run.reports)
        if (report.plan.guided && report.decisions.get<GuidingVerdict>().efficiency.efficiency > 0) told = &report;
    ASSERT_NE(told, nullptr);
    EXPECT_LT(told->decisions.get<GuidingVerdict>().efficiency.high(), 0.65);
    EXPECT_LE(told->plan.spp, 8u) << "after the first pass that has a say";

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

/// What guided paths tell of unguided ones is what unguided ones are, where these meet the light often.
TEST(Guided, PathsTellTheVarianceAndCostOfUnguidedOnes) {
    Scene scene = load_scene(test::own_scene("cornell-box.xml"), {}, false).scene;
    scene.film.width = scene.film.height = 48;
    Job job = automatic_job(127);
    job.guiding.rule = Rule::while_it_pays;
    job.integrator.light_samples = 1;
    const test::LocalRender run = test::render_locally(scene, job);
    const auto guided = [&](const PassReport& r) {
        return r.plan.guided && r.decisions.get<GuidingVerdict>().efficiency.efficiency > 0;
    };
    GuidingEfficiency told;
    for (const PassReport& report : run.reports)
        if (guided(report)) told = report.decisions.get<GuidingVerdict>().efficiency;
    ASSERT_GT(told.efficiency, 0);
    job.guiding.type = GuidingType::none;
    job.sampler.seed = 9;
    const test::LocalRender unguided = test::render_locally(scene, job);
    const PassPlan& plan = unguided.plans.back();
    const auto levels = image_levels(unguided.image.mean, 48);
    EXPECT_NEAR(told.unguided_variance / mean_variance(unguided.passes.back().pixels, levels, 48), 1, 0.25);
    const TraceStats& stats = unguided.stats.back();
    const double paths = 48.0 * 48.0 * plan.spp;
    const double cost = (static_cast<double>(stats.rays) + tuned<policy::kNextEvent>("next_event.shadow_ray_cost") *
                                                               static_cast<double>(stats.shadow_rays)) /
                        paths;
    EXPECT_NEAR(told.unguided_cost / cost, 1, 0.05);
}

/// Behind a blind trees of short passes bring little: unguided samples would then have four fifths of the work. Those
/// of longer ones bring much.
TEST(Guided, PathsAreKeptWhileTreesGetBetter) {
    const Scene scene = load_scene(test::own_scene("blinds.xml"), {}, false, 48, 36).scene;
    Job job;
    job.guiding.type = GuidingType::automatic;
    job.budget.spp = 127;
    job.sampler.seed = 4;
    const test::LocalRender run = test::render_locally(scene, job);
    EXPECT_TRUE(run.plans.back().guided);
    const double early = run.reports.at(3).decisions.get<GuidingVerdict>().efficiency.efficiency,
                 late = run.reports.at(5).decisions.get<GuidingVerdict>().efficiency.efficiency;
    EXPECT_LT(early, tuned<policy::kGuiding>("guiding.giving_up")) << "or this scene shows nothing";
    EXPECT_GT(late, early);
}

using Forced = std::tuple<const char*, GuidingType, float>;
class LightSamples : public testing::TestWithParam<Forced> {
  protected:
    static LoadedScene scene(const char* name) { return load_scene(test::own_scene(name), {}, false, 48, 32); }

    static Rendered reference(const char* name) {
        const LoadedScene loaded = scene(name);
        Job job;
        apply_layer(job, loaded.settings);
        job.integrator.type = "reference";
        job.integrator.max_depth = 6;
        job.budget.spp = 252;
        job.sampler.seed = 22;
        return test::rendered(test::render_locally(loaded.scene, job), loaded.scene.film);
    }
};

TEST_P(LightSamples, OfAnyNumberMakeTheSameImage) {
    const auto& [name, guiding, samples] = GetParam();
    static std::map<std::string, Rendered> references;
    if (!references.contains(name)) references[name] = reference(name);
    const LoadedScene loaded = scene(name);
    Job job;
    apply_layer(job, loaded.settings);
    job.integrator.max_depth = 6;
    job.integrator.light_samples = samples;
    job.guiding.type = guiding;
    job.guiding.combination = Combination::fixed;
    job.guiding.spatial_threshold = 1000;
    job.budget.spp = 252;
    job.sampler.seed = 21;
    expect_same(test::rendered(test::render_locally(loaded.scene, job), loaded.scene.film), references[name]);
}

INSTANTIATE_TEST_SUITE_P(Scenes, LightSamples,
                         testing::Combine(testing::Values("cornell-box.xml", "features.xml"),
                                          testing::Values(GuidingType::none, GuidingType::view),
                                          testing::Values(0.0625f, 0.25f, 1.0f)));

/// With what it decides by its own samples, where that is to sample few emitters.
TEST(LightSamplesDecided, DecidedByFinishedPassesMakeTheSameImage) {
    for (const GuidingType guiding : {GuidingType::none, GuidingType::automatic}) {
        LoadedScene loaded = load_scene(test::own_scene("bulb.xml"), {}, false, 48, 32);
        Job job;
        apply_layer(job, loaded.settings);
        job.guiding.type = guiding;
        job.budget.spp = 252;
        job.sampler.seed = 21;
        const test::LocalRender run = test::render_locally(loaded.scene, job);
        EXPECT_LT(run.reports.back().next_event_samples(), 0.9);
        job.integrator.type = "reference";
        job.sampler.seed = 22;
        expect_same(test::rendered(run, loaded.scene.film),
                    test::rendered(test::render_locally(loaded.scene, job), loaded.scene.film));
    }
}

/// An open lamp over a floor: its light is what makes the noise, and next event finds it best.
TEST(LightSamplesDecided, StayWhereTheyFindTheLight) {
    Scene scene = load_scene(test::own_scene("cornell-box.xml"), {}, false).scene;
    scene.film.width = scene.film.height = 48;
    for (const GuidingType guiding : {GuidingType::none, GuidingType::view}) {
        Job job = automatic_job(127);
        job.guiding.type = guiding;
        const test::LocalRender run = test::render_locally(scene, job);
        EXPECT_GT(run.reports.back().next_event_samples(), 0.95) << int(guiding);
    }
}

}  // namespace
}  // namespace treefarm
