// SPDX-License-Identifier: Apache-2.0
// Guided renders estimate the same image as unguided ones. Combination `fixed`: exactly unbiased, so any trend is a
// bug.
#include <gtest/gtest.h>

#include "common/config/job.h"
#include "common/metrics/z_test.h"
#include "coordinator/input/load.h"
#include "tests/support/local_render.h"
#include "tests/support/material_scenes.h"
#include "tests/support/support.h"

namespace treefarm {
namespace {

struct GuidedCase {
    const char* scene;
    NextEvent next_event;
    MisHeuristic mis = MisHeuristic::power;
    int spp_unit = 4;
    int candidates = 1, candidate_depth = 1;
    LightSelection light_selection = LightSelection::power;
    int splitting = 1;
    GuidingType type = GuidingType::ppg;
    float bootstrap = kUsualBootstrap;
};

void PrintTo(const GuidedCase& c, std::ostream* out) {
    *out << c.scene << ", next event " << static_cast<int>(c.next_event) << ", MIS " << static_cast<int>(c.mis)
         << ", candidates " << c.candidates << " to depth " << c.candidate_depth << ", light selection "
         << static_cast<int>(c.light_selection) << ", splitting " << c.splitting << ", guide "
         << static_cast<int>(c.type) << ", bootstrap " << c.bootstrap;
}

struct GuidedEstimate {
    RgbImage mean, variance;
};

GuidedEstimate render_guided(const Scene& scene, const Job& job) {
    const test::LocalRender run = test::render_locally(scene, job);
    GuidedEstimate e{RgbImage(scene.film.width, scene.film.height), RgbImage(scene.film.width, scene.film.height)};
    for (std::size_t p = 0; p < e.mean.pixels.size(); ++p) {
        e.mean.pixels[p] = Rgb(run.image.mean[p]);
        e.variance.pixels[p] = Rgb(run.image.variance[p]);
    }
    return e;
}

void expect_same_estimate(const GuidedEstimate& a, const GuidedEstimate& b) {
    const ZTestInput input{a.mean, b.mean, &a.variance, &b.variance};
    const BlockZTest blocks = block_z_test(input);
    EXPECT_TRUE(blocks.pass) << "worst block z " << blocks.max_abs_z << " at " << blocks.worst_x << ", "
                             << blocks.worst_y;
    for (const double z : blocks.image_z)
        EXPECT_LT(std::abs(z), 4.0);
    EXPECT_LT(blocks.mean_z2, 2.0);
    EXPECT_GT(blocks.mean_z2, 0.3);  // the variances are honest, not inflated
}

class GuidedAgainstUnguided : public ::testing::TestWithParam<GuidedCase> {};

TEST_P(GuidedAgainstUnguided, AgreesInEveryBlock) {
    Scene scene = load_scene(test::own_scene(GetParam().scene), {}, false).scene;
    scene.film.width = scene.film.height = 64;
    Job job;
    job.integrator.max_depth = 8;
    job.integrator.mis = GetParam().mis;
    job.sampler.seed = 1;
    job.budget.spp = 512;
    job.guiding.type = GuidingType::none;
    job.integrator.next_event = NextEvent::always;
    const GuidedEstimate unguided = render_guided(scene, job);

    job.sampler.seed = 2;
    job.budget.spp = 508;
    job.guiding.type = GetParam().type;
    job.guiding.bootstrap = GetParam().bootstrap;
    job.guiding.combination = Combination::fixed;
    job.guiding.spatial_threshold = 1000;  // a fine tree for a small image
    job.guiding.spp_unit = GetParam().spp_unit;
    job.guiding.candidates = GetParam().candidates;
    job.guiding.candidate_depth = GetParam().candidate_depth;
    job.integrator.light_selection = GetParam().light_selection;
    job.guiding.splitting = GetParam().splitting;
    job.integrator.next_event = GetParam().next_event;
    const GuidedEstimate guided = render_guided(scene, job);

    expect_same_estimate(guided, unguided);
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, GuidedAgainstUnguided,
    ::testing::Values(
        GuidedCase{"cornell-box.xml", NextEvent::never}, GuidedCase{"cornell-box.xml", NextEvent::always},
        GuidedCase{"cornell-box.xml", NextEvent::kickstart},
        GuidedCase{"cornell-box.xml", NextEvent::always, MisHeuristic::balance, 1},
        GuidedCase{"cornell-box.xml", NextEvent::never, MisHeuristic::balance, 1, 2},
        GuidedCase{"cornell-box.xml", NextEvent::always, MisHeuristic::balance, 1, 4, 8},
        GuidedCase{"caustic.xml", NextEvent::kickstart, MisHeuristic::power, 1, 3, 8},
        GuidedCase{"diffuse-room.xml", NextEvent::always, MisHeuristic::balance, 1, 1, 1, LightSelection::learned},
        GuidedCase{"features.xml", NextEvent::always, MisHeuristic::balance, 1, 2, 1, LightSelection::learned},
        GuidedCase{"cornell-box.xml", NextEvent::never, MisHeuristic::balance, 1, 1, 1, LightSelection::power, 32},
        GuidedCase{"door-ajar.xml", NextEvent::always, MisHeuristic::power, 1, 2, 8, LightSelection::power, 8},
        GuidedCase{"features.xml", NextEvent::always, MisHeuristic::power, 1, 1, 1, LightSelection::learned, 32},
        GuidedCase{"features.xml", NextEvent::always, MisHeuristic::balance, 1, 1, 1, LightSelection::power},
        GuidedCase{"cornell-box.xml", NextEvent::never, MisHeuristic::balance, 1, 1, 1, LightSelection::power, 1,
                   GuidingType::grid},
        GuidedCase{"features.xml", NextEvent::kickstart, MisHeuristic::balance, 1, 2, 8, LightSelection::learned, 4,
                   GuidingType::grid},
        GuidedCase{"door-ajar.xml", NextEvent::always, MisHeuristic::power, 1, 1, 1, LightSelection::power, 1,
                   GuidingType::grid},
        GuidedCase{"cornell-box.xml", NextEvent::never, MisHeuristic::balance, 1, 1, 1, LightSelection::power, 1,
                   GuidingType::qtable},
        GuidedCase{"features.xml", NextEvent::kickstart, MisHeuristic::balance, 1, 2, 8, LightSelection::learned, 4,
                   GuidingType::qtable},
        GuidedCase{"cornell-box.xml", NextEvent::never, MisHeuristic::balance, 1, 1, 1, LightSelection::power, 1,
                   GuidingType::ppg, 1.0f},
        GuidedCase{"features.xml", NextEvent::always, MisHeuristic::balance, 1, 1, 1, LightSelection::learned, 4,
                   GuidingType::view, 0.9f},
        GuidedCase{"door-ajar.xml", NextEvent::always}, GuidedCase{"door-ajar.xml", NextEvent::kickstart}));

/// A guided job for a small image.
Job with_a_fine_tree(std::uint32_t spp) {
    Job job;
    job.integrator.max_depth = 8;
    job.budget.spp = spp;
    job.guiding.type = GuidingType::ppg;
    job.guiding.combination = Combination::fixed;
    job.guiding.spatial_threshold = 1000;
    return job;
}

/// Against one: in this room a few rare samples make up so much of what unguided paths see that blocks do not know
/// their own variance.
TEST(SeveralCandidates, EstimateTheSameImageOfAGlossyRoom) {
    Scene scene = load_scene(test::own_scene("glossy-room.xml"), {}, false).scene;
    scene.film.width = scene.film.height = 48;
    Job job = with_a_fine_tree(1016);
    job.guiding.candidate_depth = 8;
    job.guiding.candidates = 1;
    job.sampler.seed = 1;
    const GuidedEstimate one = render_guided(scene, job);
    for (const int candidates : {2, 4}) {
        job.guiding.candidates = candidates;
        job.sampler.seed = 2;
        expect_same_estimate(render_guided(scene, job), one);
    }
}

/// A room behind a pane that mirrors the sky: a tree that is learned on both ways against one learned on either.
TEST(SplitGlass, EstimatesTheSameImage) {
    Scene scene = test::cornell_box(1.0f, Vec3(0.0f));
    const std::int32_t pane = test::add_material(scene, ThinDielectricMaterial{1.5f, Rgb(1.0f), Rgb(0.9f)});
    test::add_shape(scene, test::quad({-2, -2, -0.2f}, {5, 0, 0}, {0, 5, 0.3f}), pane);
    scene.emitters.push_back({ConstantEmitter{Rgb(2.0f)}, {}});
    test::set_film(scene, 64, 64);
    Job job = with_a_fine_tree(508);
    job.integrator.split_glass = false;
    job.sampler.seed = 1;
    const GuidedEstimate tossed = render_guided(scene, job);
    job.integrator.split_glass = true;
    job.sampler.seed = 2;
    expect_same_estimate(render_guided(scene, job), tossed);
}

}  // namespace
}  // namespace treefarm
