// SPDX-License-Identifier: Apache-2.0
// Bidirectional path tracing against path tracing in every scene of configs/scenes, up to each number of edges. Lights
// without extent are left out: what comes from them over mirrors path tracing does not find.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "common/config/job_reader.h"
#include "common/metrics/z_test.h"
#include "common/plan/effects/effects.h"
#include "coordinator/input/load.h"
#include "tests/support/rendered.h"

namespace treefarm {
namespace {

constexpr int kWidth = 48, kHeight = 32, kMostEdges = 8;

test::Rendered render(const Scene& scene, Job job, const char* type, std::uint32_t spp) {
    job.integrator.type = type;
    job.bidirectional.light_subpaths = Rule::always;
    job.sampler.seed = type[0] == 'r' ? 101 : 202;
    job.budget.spp = spp;
    return test::rendered(test::render_locally(scene, job), scene.film);
}

TEST(Bidirectional, IsPathTracingInEveryScene) {
    std::vector<std::filesystem::path> files;
    for (const auto& file : std::filesystem::directory_iterator(TREEFARM_SOURCE_DIR "/configs/scenes"))
        if (file.path().extension() == ".xml") files.push_back(file.path());
    std::sort(files.begin(), files.end());
    ASSERT_GE(files.size(), 8u);
    for (const auto& file : files) {
        LoadedScene loaded = load_scene(file.string(), {}, false, kWidth, kHeight);
        Job job;
        apply_layer(job, loaded.settings);
        job.guiding.type = GuidingType::none;
        job.guiding.combination = Combination::fixed;
        job.integrator.next_event = NextEvent::always;
        job.effects.off.insert("delta_lights");
        plan_effects(loaded.scene, job);
        for (int edges = 1; edges <= kMostEdges; ++edges) {
            job.integrator.max_depth = edges;
            const test::Rendered path = render(loaded.scene, job, "reference", 508),
                                 both = render(loaded.scene, job, "bidirectional", 124);
            ZTestOptions options;
            options.block = 8;
            // All tests together are red once in a hundred times by chance.
            options.significance = 0.01 / (kMostEdges * static_cast<double>(files.size()));
            const ZTestInput input{both.mean, path.mean, &both.variance, &path.variance};
            const BlockZTest blocks = block_z_test(input, options);
            const std::string where = file.stem().string() + ", " + std::to_string(edges) + " edges";
            EXPECT_TRUE(blocks.pass) << where << ": worst block z " << blocks.max_abs_z << " of " << blocks.limit;
            for (const double z : blocks.image_z)
                EXPECT_LT(std::abs(z), 4.0) << where;
        }
    }
}

}  // namespace
}  // namespace treefarm
