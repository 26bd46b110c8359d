// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "common/config/job_reader.h"
#include "coordinator/input/load.h"
#include "tests/support/chi_square.h"
#include "tests/support/rendered.h"
#include "tests/support/support.h"
#include "tests/support/test_scenes.h"

namespace treefarm {
namespace {

using test::Rendered;

Rendered render_reference(const Scene& scene, const Job& job) {
    return test::rendered(test::render_locally(scene, job), scene.film);
}

/// Names of the scenes in configs/scenes, one that comes tomorrow included.
std::vector<std::string> own_scenes() {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(test::own_scene("")))
        if (entry.path().extension() == ".xml") names.push_back(entry.path().stem());
    std::ranges::sort(names);
    return names;
}

class OwnScenes : public testing::TestWithParam<std::string> {};

/// With other random numbers, and with glass split in one of them: equal in expectation.
TEST_P(OwnScenes, ReferenceAndUnguidedPathAgree) {
    const LoadedScene loaded = load_scene(test::own_scene(GetParam() + ".xml"), {}, false, 48, 32);
    Job job;
    apply_layer(job, loaded.settings);
    job.budget.spp = 252;
    job.guiding.type = GuidingType::none;
    job.sampler.seed = 21;
    const Rendered path = render_reference(loaded.scene, job);
    job.integrator.type = "reference";
    job.sampler.seed = 22;
    const Rendered reference = render_reference(loaded.scene, job);
    test::expect_z_tests_pass({path.mean, reference.mean, &path.variance, &reference.variance});
}

INSTANTIATE_TEST_SUITE_P(Scenes, OwnScenes, testing::ValuesIn(own_scenes()), [](const auto& info) {
    std::string name = info.param;
    std::erase(name, '-');
    return name;
});

TEST(Reference, FurnaceHasTheExactMean) {
    for (const float albedo : {0.5f, 0.8f})
        for (const NextEvent next_event : {NextEvent::never, NextEvent::always})
            for (const MisHeuristic mis : {MisHeuristic::balance, MisHeuristic::power, MisHeuristic::equal}) {
                const Scene scene = test::furnace(albedo, 1.0f, 2.0f, Vec3(0.3f, -0.2f, 0.1f));
                Job job;
                job.integrator.type = "reference";
                job.integrator.next_event = next_event;
                job.integrator.mis = mis;
                job.budget.spp = 1020;
                job.sampler.seed = 3;
                const test::LocalRender run = test::render_locally(scene, job);
                Moments all;
                for (const PixelEstimate& pixel : run.passes.back().pixels)
                    all = Moments::merge(all, pixel.whole());
                const double exact = 1.0 / (1.0 - double(albedo)), error = std::sqrt(all.sample_variance().x / all.n);
                const double z = std::max(0.0, std::abs(all.mean.x - exact) - 1e-5 * exact) / std::max(error, 1e-9);
                EXPECT_GT(test::normal_p_value(z), 1e-4) << all.mean.x << " +- " << error << ", not " << exact;
            }
}

}  // namespace
}  // namespace treefarm
