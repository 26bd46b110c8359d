// SPDX-License-Identifier: Apache-2.0
// What the list of estimators says of each, against what it does: plans, checks and documentation believe the list.
#include "common/config/estimators.h"

#include <gtest/gtest.h>

#include "tests/support/aov_render.h"

namespace treefarm {
namespace {

/// Means of all pixels of four samples, of an estimator that is told to follow so many edges.
std::vector<Rgb64> render(const Estimator& estimator, float lamp, int max_depth, int emitter_samples = 1) {
    Scene scene = test::cornell_box(1.0f, Vec3(0.0f));
    test::set_film(scene, 8, 8);
    std::get<AreaEmitter>(scene.emitters[0].kind).radiance.value *= lamp;
    Job job;
    job.integrator.type = estimator.type;
    job.integrator.max_depth = max_depth;
    job.integrator.emitter_samples = emitter_samples;
    std::vector<Rgb64> means;
    for (const PixelEstimate& pixel : test::render_layers(scene, "", 4, job).pixels)
        means.push_back(pixel.whole().mean);
    return means;
}

TEST(EstimatorList, SaysWhoDependsOnLight) {
    for (const Estimator& estimator : estimators())
        EXPECT_EQ(render(estimator, 1.0f, 5) != render(estimator, 2.0f, 5), estimator.sees_light) << estimator.type;
}

TEST(EstimatorList, SaysWhoCountsItsSamples) {
    for (const Estimator& estimator : estimators())
        EXPECT_EQ(render(estimator, 1.0f, 5, 1) != render(estimator, 1.0f, 5, 3), estimator.by_numbers)
            << estimator.type;
}

TEST(EstimatorList, SaysWhoTeachesATree) {
    Scene scene = test::cornell_box(1.0f, Vec3(0.0f));
    test::set_film(scene, 8, 8);
    for (const Estimator& estimator : estimators()) {
        Job job;
        job.integrator.type = estimator.type;
        job.guiding.type = GuidingType::ppg;
        const Resolved resolved = resolve(job, scene);
        const AnyModel tree = first_model(resolved, scene.bounds(), 1.0f);
        const AnySampler guide(tree);
        PassPlan pass = plan_passes(resolved)[0];
        pass.kernel = kernel_of(resolved, pass, facts_of(tree));
        UnitOutput output;
        output.begin(guide, pass.layers.splats);
        make_renderer(scene, resolved)(pass, guide, cut_pass(pass, 8, 8, 8)[0], output);
        EXPECT_EQ(!output.log.of<SdTreeGuide>().records.empty(), estimator.guides) << estimator.type;
    }
}

/// More edges than the list says change nothing, and one less does where light is to be seen.
TEST(EstimatorList, SaysHowManyEdgesAreFollowed) {
    for (const Estimator& estimator : estimators()) {
        const int most = estimator.depth == 0 ? 5 : estimator.depth;
        EXPECT_EQ(render(estimator, 1.0f, most) == render(estimator, 1.0f, most + 1), estimator.depth != 0)
            << estimator.type;
        if (estimator.sees_light) {
            EXPECT_NE(render(estimator, 1.0f, most - 1), render(estimator, 1.0f, most)) << estimator.type;
        }
    }
}

}  // namespace
}  // namespace treefarm
