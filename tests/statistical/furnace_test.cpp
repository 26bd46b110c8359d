// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/support/chi_square.h"
#include "tests/support/local_render.h"
#include "tests/support/test_scenes.h"

namespace treefarm {
namespace {

/// A closed room that emits 1 and reflects the share a everywhere: every ray carries 1 / (1 - a), whatever the method.
struct Method {
    std::string name;
    GuidingType guiding;
    NextEvent next_event;
    MisHeuristic mis;
    float albedo;
    bool learned = false;  ///< the mixture of BSDF and tree
    float bootstrap = kUsualBootstrap;
};

std::vector<Method> methods() {
    std::vector<Method> all;
    for (const GuidingType guiding : {GuidingType::none, GuidingType::ppg})
        for (const NextEvent next_event : {NextEvent::never, NextEvent::always, NextEvent::kickstart})
            for (const MisHeuristic mis : {MisHeuristic::balance, MisHeuristic::power})
                for (const float albedo : {0.5f, 0.8f}) {
                    if (next_event == NextEvent::never && mis == MisHeuristic::power) continue;
                    if (guiding == GuidingType::none && next_event == NextEvent::kickstart) continue;
                    const char* kinds[] = {"Never", "Always", "Kickstart"};
                    all.push_back({std::string(guiding == GuidingType::none ? "Unguided" : "Guided") +
                                       kinds[static_cast<int>(next_event)] +
                                       (mis == MisHeuristic::balance ? "Balance" : "Power") +
                                       std::to_string(int(albedo * 10.01f)),
                                   guiding, next_event, mis, albedo});
                }
    for (const GuidingType guiding : {GuidingType::none, GuidingType::ppg})
        all.push_back({guiding == GuidingType::none ? "UnguidedAlwaysEqual8" : "GuidedAlwaysEqual8", guiding,
                       NextEvent::always, MisHeuristic::equal, 0.8f});
    for (const float albedo : {0.5f, 0.8f})
        all.push_back({"LearnedNever" + std::to_string(int(albedo * 10.01f)), GuidingType::ppg, NextEvent::never,
                       MisHeuristic::balance, albedo, true});
    for (const NextEvent next_event : {NextEvent::never, NextEvent::always, NextEvent::kickstart})
        all.push_back({"Grid" + std::to_string(static_cast<int>(next_event)), GuidingType::grid, next_event,
                       MisHeuristic::balance, 0.8f, true});
    for (const NextEvent next_event : {NextEvent::never, NextEvent::kickstart})
        all.push_back({"QTable" + std::to_string(static_cast<int>(next_event)), GuidingType::qtable, next_event,
                       MisHeuristic::balance, 0.8f, true});
    for (const GuidingType guiding : {GuidingType::ppg, GuidingType::grid})
        all.push_back({guiding == GuidingType::ppg ? "BootstrappedTree" : "BootstrappedGrid", guiding, NextEvent::never,
                       MisHeuristic::balance, 0.8f, true, 0.9f});
    return all;
}

class Furnace : public testing::TestWithParam<Method> {};

/// Mean over all pixels of a pass and its standard error.
struct Mean {
    double value = 0, error = 0;
};

Mean mean_of(const PassResult& pass) {
    Moments all;
    for (const PixelEstimate& pixel : pass.pixels)
        all = Moments::merge(all, pixel.whole());
    return {all.mean.x, std::sqrt(all.sample_variance().x / all.n)};
}

TEST_P(Furnace, EveryPassHasTheExactMean) {
    const Method& method = GetParam();
    Scene scene = test::furnace(method.albedo, 1.0f, 2.0f, Vec3(0.3f, -0.2f, 0.1f));
    test::set_film(scene, 16, 16);
    Job job;
    job.guiding.type = method.guiding;
    job.guiding.spatial_threshold = 500;
    job.guiding.spp_unit = 4;
    job.guiding.learn_bsdf_fraction = method.learned;
    job.guiding.bootstrap = method.bootstrap;
    job.integrator.next_event = method.next_event;
    job.integrator.mis = method.mis;
    job.budget.spp = 252;
    job.sampler.seed = 12;
    const test::LocalRender run = test::render_locally(scene, job);
    ASSERT_GT(run.passes.size(), 4u);
    if (method.guiding != GuidingType::none) {
        EXPECT_GT(run.model.regions().leaf_count(), 8u) << "the last passes are guided by a real tree";
    }
    const double exact = 1.0 / (1.0 - double(method.albedo));
    for (const PassResult& pass : run.passes) {
        // A mixture that has found the BSDF to be perfect, as it is here, leaves nothing but rare events to the
        // variance: short passes are far from normal.
        if (method.learned && pass.spp < 32) continue;
        const Mean mean = mean_of(pass);
        // What leaks through edges and is lost to rounding stays below 1e-5 of the value.
        const double z = std::max(0.0, std::abs(mean.value - exact) - 1e-5 * exact) / std::max(mean.error, 1e-9);
        EXPECT_GT(test::normal_p_value(z), 1e-4)
            << "pass of " << pass.spp << " spp: " << mean.value << " +- " << mean.error << ", not " << exact;
    }
    for (const TraceStats& stats : run.stats)
        EXPECT_EQ(stats.invalid_samples, 0u);
}

INSTANTIATE_TEST_SUITE_P(Methods, Furnace, testing::ValuesIn(methods()),
                         [](const auto& info) { return info.param.name; });

TEST(DeepFurnace, AThousandBouncesStayExact) {
    Scene scene = test::furnace(0.999f, 1.0f, 2.0f, Vec3(0.0f));
    test::set_film(scene, 8, 8);
    for (const NextEvent next_event : {NextEvent::never, NextEvent::always}) {
        Job job;
        job.guiding.type = GuidingType::none;
        job.integrator.max_depth = 1000;
        job.integrator.rr_depth = 2000;  // never: without roulette and next event, all paths have the same value
        job.integrator.next_event = next_event;
        job.budget.spp = 16;
        const test::LocalRender run = test::render_locally(scene, job);
        const double exact = (1 - std::pow(0.999, 1000)) / (1 - 0.999);
        for (const PassResult& pass : run.passes) {
            const Mean mean = mean_of(pass);
            EXPECT_NEAR(mean.value, exact, 4.5 * mean.error + 1e-3 * exact) << mean.error;
        }
    }
}

TEST(GuidedCornellBox, AgreesWithPathTracing) {
    Scene scene = test::cornell_box(1.0f, Vec3(0.0f));
    test::set_film(scene, 24, 24);
    Job job;
    job.guiding.type = GuidingType::none;
    job.guiding.combination = Combination::fixed;
    job.guiding.spatial_threshold = 1000;
    job.integrator.max_depth = 8;
    job.budget.spp = 508;
    const auto image_mean = [](const test::LocalRender& run) {
        Mean all;
        for (std::size_t i = 0; i < run.image.mean.size(); ++i) {
            all.value += run.image.mean[i].x;
            all.error += run.image.variance[i].x;
        }
        const auto pixels = static_cast<double>(run.image.mean.size());
        return Mean{all.value / pixels, std::sqrt(all.error) / pixels};
    };
    const Mean reference = image_mean(test::render_locally(scene, job));
    job.guiding.type = GuidingType::ppg;
    for (const NextEvent next_event : {NextEvent::always, NextEvent::kickstart, NextEvent::never}) {
        job.integrator.next_event = next_event;
        job.sampler.seed += 1;
        const Mean guided = image_mean(test::render_locally(scene, job));
        const double z = (guided.value - reference.value) / std::hypot(guided.error, reference.error);
        EXPECT_GT(test::normal_p_value(z), 1e-4)
            << guided.value << " +- " << guided.error << " against " << reference.value << " +- " << reference.error;
    }
}

}  // namespace
}  // namespace treefarm
