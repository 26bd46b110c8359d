// SPDX-License-Identifier: Apache-2.0
// What bidirectional and light tracing renders learn of themselves changes no image: which emitters light paths start
// from, and whether they are traced at all. With more emitters than are chosen one by one.
#include <gtest/gtest.h>

#include "coordinator/input/load.h"
#include "tests/support/rendered.h"
#include "tests/support/support.h"
#include "tests/support/test_scenes.h"

namespace treefarm {
namespace {

using test::expect_same_image;
using test::LocalRender;
using test::Rendered;

/// A long hall of 9 bays, each behind a wall with a gap, with lamps of three kinds: the camera sees the first alone.
Scene hall(bool with_points) {
    Scene scene;
    const std::int32_t grey = test::add_diffuse(scene, Rgb(0.6f));
    Material twosided = scene.materials[static_cast<std::size_t>(grey)];
    twosided.twosided = true;
    scene.materials.push_back(twosided);
    const auto wall = static_cast<std::int32_t>(scene.materials.size()) - 1;
    test::add_shape(scene, test::quad({-2, 0, -2}, {0, 0, 40}, {4, 0, 0}), grey);
    for (int bay = 0; bay < 9; ++bay) {
        const float z = 4.0f * static_cast<float>(bay);
        test::add_shape(scene, test::quad({-2, 0.3f, z + 2}, {4, 0, 0}, {0, 3, 0}), wall);
        test::add_shape(scene, test::quad({-1.5f, 3, z - 0.3f}, {0.4f, 0, 0}, {0, 0, 0.4f}), kNone, Rgb(6, 5, 4));
        test::add_shape(scene, Sphere{Vec3(1.2f, 2.2f, z), 0.15f, false}, kNone, Rgb(20.0f));
        if (with_points) scene.emitters.push_back({PointEmitter{{0, 2.5f, z}, Rgb(1.0f, 1.5f, 2.0f)}, {}});
    }
    scene.camera = test::look_at({0, 2.0f, -1.9f}, {0, 0.3f, 0.5f}, {0, 1, 0}, 0.5f);
    test::set_film(scene, 32, 32);
    return scene;
}

LocalRender render_both_ends(const Scene& scene, const char* type, std::uint32_t spp, LightSelection how,
                             bool next_event = true, Rule subpaths = Rule::always) {
    Job job;
    job.integrator.type = type;
    job.integrator.hide_emitters = true;
    job.integrator.light_selection = how;
    job.integrator.next_event = next_event ? NextEvent::always : NextEvent::never;
    job.integrator.max_depth = 5;
    job.guiding.type = GuidingType::none;
    job.bidirectional.light_subpaths = subpaths;
    job.budget.spp = spp;
    job.sampler.seed = static_cast<std::uint64_t>(type[0]) + spp;
    return test::render_locally(scene, job);
}

double last_pass_variance(const LocalRender& run) {
    return pass_variance(run.passes.back().pixels).mse_of_sample;
}

/// Eighteen lamps and more are chosen by a tree: next event by what they bring to the point, light paths by what theirs
/// brought to the image.
TEST(ManyLamps, LearnedSharesChangeNoImage) {
    const Scene scene = hall(true);
    const Rendered path = test::rendered(render_both_ends(scene, "reference", 124, LightSelection::tree), scene.film);
    for (const char* const type : {"light", "bidirectional"}) {
        const LocalRender run = render_both_ends(scene, type, 124, LightSelection::learned);
        ASSERT_GT(run.plans.size(), 2u);
        EXPECT_TRUE(run.plans.front().emission.empty());
        EXPECT_GE(run.plans.back().emission.size(), 27u) << type;
        expect_same_image(test::rendered(run, scene.film), path, type, 0.03);
    }
}

/// Without next event the lights without extent are sampled alone. Both ends of a path then take their choice to be
/// alike, however differently they are chosen: weights still sum to one, since all techniques do.
TEST(ManyLamps, LightsWithoutExtentAlone) {
    const Scene scene = hall(true);
    const Rendered path = test::rendered(render_both_ends(scene, "reference", 252, LightSelection::tree), scene.film);
    expect_same_image(
        test::rendered(render_both_ends(scene, "bidirectional", 124, LightSelection::learned, false), scene.film), path,
        "delta alone", 0.03);
}

/// One of nine bays is seen: paths that start elsewhere bring nothing.
TEST(ManyLamps, LightPathsStartWhereTheyAreSeen) {
    const Scene scene = hall(false);
    for (const char* const type : {"light", "bidirectional"}) {
        const LocalRender by_power = render_both_ends(scene, type, 60, LightSelection::tree),
                          learned = render_both_ends(scene, type, 60, LightSelection::learned);
        EXPECT_TRUE(by_power.plans.back().emission.empty());
        const double gain = last_pass_variance(by_power) / last_pass_variance(learned);
        EXPECT_GT(gain, type[0] == 'l' ? 3.0 : 0.9) << type;  // where next event finds all, there is little to gain
    }
}

/// Under an open sky light paths are lost: they are given up, and the image stays what it is.
TEST(LightSubpaths, AreGivenUpWhereTheyDoNotPay) {
    Scene scene;
    test::add_shape(scene, test::quad({-8, 0, -8}, {0, 0, 16}, {16, 0, 0}), test::add_diffuse(scene, Rgb(0.5f)));
    test::add_shape(scene, test::sphere_mesh({0.2f, 0.7f, 0.5f}, 0.6f, 2, true), test::add_diffuse(scene, Rgb(0.7f)));
    scene.emitters.push_back({ConstantEmitter{Rgb(0.4f, 0.5f, 0.7f)}, {}});
    scene.camera = test::look_at({1.2f, 1.6f, -3.5f}, {0, 0.8f, 0.3f}, {0, 1, 0}, 0.45f);
    test::set_film(scene, 32, 32);
    const LocalRender run =
        render_both_ends(scene, "bidirectional", 60, LightSelection::learned, true, Rule::while_it_pays);
    EXPECT_TRUE(run.plans.front().light_subpaths);
    EXPECT_FALSE(run.plans.back().light_subpaths);
    EXPECT_EQ(run.plans.back().layers.splats.pixels, 0u);
    EXPECT_GT(light_subpath_gain(run.stats[2].sums<LightSubpathSums>(), run.stats[2]).noise, 0);
    EXPECT_LT(light_subpath_gain(run.stats[2].sums<LightSubpathSums>(), run.stats[2]).at_equal_cost(), 0.9);
    EXPECT_NEAR(light_subpath_gain(run.stats[2].sums<LightSubpathSums>(), run.stats[2]).mean_ratio, 1, 0.05);
    EXPECT_EQ(light_subpath_gain(run.stats.back().sums<LightSubpathSums>(), run.stats.back()).noise, 0)
        << "nothing to compare";
    const Rendered path = test::rendered(render_both_ends(scene, "reference", 60, LightSelection::tree), scene.film);
    expect_same_image(test::rendered(run, scene.film), path, "open sky", 0.02);
}

/// What samples say of paths from the camera alone is what path tracing shows.
TEST(LightSubpaths, PathsAloneAreThoseOfPathTracing) {
    Scene scene = test::cornell_box(1.0f, Vec3(0.0f));
    test::set_film(scene, 32, 32);
    const LocalRender both =
                          render_both_ends(scene, "bidirectional", 60, LightSelection::tree, true, Rule::while_it_pays),
                      path = render_both_ends(scene, "reference", 60, LightSelection::tree);
    ASSERT_TRUE(both.plans[2].light_subpaths);
    const LightSubpathGain gain = light_subpath_gain(both.stats[2].sums<LightSubpathSums>(), both.stats[2]);
    const double shown =
        pass_variance(path.passes[2].pixels).mse_of_sample / pass_variance(both.passes[2].pixels).mse_of_sample;
    EXPECT_NEAR(gain.noise / shown, 1, 0.15);
    const auto rays = [](const TraceStats& s) { return double(s.rays + s.shadow_rays) / double(s.paths); };
    EXPECT_NEAR(gain.rays / (rays(both.stats[2]) / rays(path.stats[2])), 1, 0.03);
    EXPECT_NEAR(gain.mean_ratio, 1, 0.03);
}

class Caustics : public testing::TestWithParam<const char*> {};

/// Paths from the camera hardly meet a lamp by way of water or glass: they look quiet, and only the light that they
/// miss tells.
TEST_P(Caustics, KeepLightSubpathsWhereCameraPathsHaveMetNoneYet) {
    const Scene scene = load_scene(test::own_scene(GetParam()), {}, false, 64, 48).scene;
    int kept = 0, looked_quiet = 0;
    for (const std::uint32_t spp : {24u, 26u, 28u, 30u}) {  // each has a seed of its own
        const LocalRender run =
            render_both_ends(scene, "bidirectional", spp, LightSelection::learned, true, Rule::while_it_pays);
        kept += run.plans.back().light_subpaths;
        const LightSubpathSums& sums = run.stats[2].sums<LightSubpathSums>();
        LightSubpathGain seen = light_subpath_gain(run.stats[2].sums<LightSubpathSums>(), run.stats[2]);
        seen.noise = static_cast<double>(sums.alone_variance) / static_cast<double>(sums.both_variance);
        looked_quiet += seen.at_equal_cost() < 0.9;
    }
    EXPECT_GE(kept, 3);
    EXPECT_GE(looked_quiet, 2) << "by the variance of a pass";
}

INSTANTIATE_TEST_SUITE_P(Scenes, Caustics, testing::Values("water.xml", "caustic.xml"));

/// What points throw by way of glass no path from the camera finds: subpaths stay, whatever they cost.
TEST(LightSubpaths, StayWhereOnlyTheyFindTheLight) {
    Scene scene = hall(true);
    EXPECT_EQ(resolve(Job(), scene).bidirectional.light_subpaths, Rule::while_it_pays);
    scene.materials.push_back({});
    scene.materials.back().bsdf = DielectricMaterial{};
    test::add_shape(scene, test::quad({-1, 1, -1}, {0, 0, 1}, {1, 0, 0}),
                    static_cast<std::int32_t>(scene.materials.size()) - 1);
    EXPECT_EQ(resolve(Job(), scene).bidirectional.light_subpaths, Rule::always);
}

}  // namespace
}  // namespace treefarm
