// SPDX-License-Identifier: Apache-2.0
// What guides have learned of light, against what it is: by rendering.
#include <gtest/gtest.h>

#include "common/math/direction_map.h"
#include "tests/support/local_render.h"
#include "tests/support/test_scenes.h"

namespace treefarm {
namespace {

/// A closed room that emits 1 and reflects `albedo`: what arrives is 1 / (1 - albedo) anywhere. Next event would take
/// the emission over.
Job job_of(GuidingType type, float bootstrap, std::uint32_t spp) {
    Job job;
    job.guiding.type = type;
    job.guiding.bootstrap = bootstrap;
    job.guiding.grid_halvings = 6;
    job.integrator.next_event = NextEvent::never;
    job.budget.spp = spp;
    job.sampler.seed = 5;
    return job;
}

/// Mean of what a model knows to arrive at `p` from directions within 60 degrees of the normal `n`.
double arriving(const AnyModel& model, const Vec3& p, const Vec3& n) {
    const AnySampler sampler(model);
    return sampler.visit([&]<class G>(const auto& guide) {
        double sum = 0, count = 0;
        for (std::uint32_t i = 0; i < 4096; ++i) {
            const Vec3 d = square_to_direction(
                {(static_cast<float>(i % 64) + 0.5f) / 64.0f, (static_cast<float>(i / 64) + 0.5f) / 64.0f});
            if (dot(d, n) < 0.5f) continue;
            sum += double(guide.radiance(guide.region(p), direction_to_code(d)));
            ++count;
        }
        return sum / count;
    });
}

class QLearning : public testing::TestWithParam<std::pair<GuidingType, float>> {};

/// The light that a region has learned is the light that there is, by whatever part of it is bootstrapped. Cells across
/// the horizon hold light on one side only: their sums spread it over both, which bootstrapping then learns again and
/// again; means of visits do not.
TEST_P(QLearning, KnowsTheLightOfAFurnace) {
    Scene scene = test::furnace(0.5f, 1.0f, 2.0f, Vec3(0.0f));
    test::set_film(scene, 32, 32);
    const Job job = job_of(GetParam().first, GetParam().second, 1020);
    const test::LocalRender run = test::render_locally(scene, job);
    // In the middle of a wall: in corners, cells of several walls are one.
    const double known = arriving(run.model, Vec3(0.3f, 0.4f, 0.99f), Vec3(0, 0, -1));
    EXPECT_LT(known, 2.06);
    EXPECT_GT(known, GetParam().first == GuidingType::qtable ? 1.94 : 1.6);
}

INSTANTIATE_TEST_SUITE_P(Guides, QLearning,
                         testing::Values(std::pair(GuidingType::qtable, 1.0f), std::pair(GuidingType::qtable, 0.5f),
                                         std::pair(GuidingType::grid, 0.9f), std::pair(GuidingType::ppg, 0.9f),
                                         std::pair(GuidingType::ppg, 1.0f)));

/// From nothing a table learns one bounce a pass.
TEST(QTable, LearnsOneBounceAPass) {
    Scene scene = test::furnace(0.5f, 1.0f, 2.0f, Vec3(0.0f));
    test::set_film(scene, 32, 32);
    Job job = job_of(GuidingType::qtable, 1.0f, 0);
    job.guiding.spp_unit = 64;
    job.guiding.learn_bsdf_fraction = false;
    job.guiding.bsdf_fraction = 1.0f;  // so that each pass visits each cell twice as often as the one before
    double q = 0, visits = 0;
    for (int passes = 1; passes <= 3; ++passes) {
        job.budget.spp = 64u * ((2u << passes) - 1);  // and one more pass, which the model guides
        const test::LocalRender run = test::render_locally(scene, job);
        const double fresh = 1.0 + 0.5 * q, n = 1 << passes;
        q = (q * visits / 2 + fresh * n) / (visits / 2 + n);
        visits = visits / 2 + n;
        ASSERT_EQ(run.passes.size(), static_cast<std::size_t>(passes) + 1);
        EXPECT_NEAR(arriving(run.model, Vec3(0.3f, 0.4f, 0.99f), Vec3(0, 0, -1)), q, 0.03) << passes;
    }
}

/// Two planes, wide for their distance, the upper of which emits.
TEST(QTable, KnowsTheLightBetweenTwoPlanes) {
    Scene scene;
    const float half = 10.0f;
    const std::int32_t lower = test::add_diffuse(scene, Rgb(0.5f)), upper = test::add_diffuse(scene, Rgb(0.2f));
    const Vec3 x(2 * half, 0, 0), y(0, 2 * half, 0), corner(-half, -half, 0);
    test::add_shape(scene, test::quad(corner, x, y), lower);
    test::add_shape(scene, test::quad(corner + Vec3(0, 0, 1), y, x), upper, Rgb(1.0f));
    scene.camera = test::look_at(Vec3(0, 0, 0.5f), Vec3(0, 0, 1), Vec3(0, 1, 0), 1.0f);
    test::set_film(scene, 32, 32);
    Job job = job_of(GuidingType::qtable, 1.0f, 1020);
    job.guiding.grid_halvings = 15;
    const test::LocalRender run = test::render_locally(scene, job);
    const double exact = 1 / (1 - 0.5 * 0.2);
    const Vec3 at_lower(0.1f, 0.1f, 0.0f), at_upper(0.1f, 0.1f, 1.0f);
    const auto known = [&](const Vec3& p, const Vec3& d) {
        return double(AnySampler(run.model).get<QTableSampler>().radiance(AnySampler(run.model).regions().region(p),
                                                                          direction_to_code(normalize(d))));
    };
    // Some paths get out between them: 1 % a bounce and more.
    EXPECT_NEAR(known(at_lower, Vec3(0.2f, 0.1f, 1.0f)), exact, 0.05 * exact);
    EXPECT_NEAR(known(at_upper, Vec3(0.2f, 0.1f, -1.0f)), 0.5 * exact, 0.05 * 0.5 * exact);
}

}  // namespace
}  // namespace treefarm
