// SPDX-License-Identifier: Apache-2.0
// Against an independent renderer's references, where ../shared/scenes is present.
#include <gtest/gtest.h>

#include "common/config/job_reader.h"
#include "common/image/exr.h"
#include "common/metrics/error_metrics.h"
#include "common/metrics/z_test.h"
#include "coordinator/input/load.h"
#include "tests/support/local_render.h"
#include "tests/support/support.h"

namespace treefarm {
namespace {

class CornellReference : public ::testing::TestWithParam<GuidingType> {};

TEST_P(CornellReference, AgreesInTheZTests) {
    const std::string path = test::shared_scene("cbox/cbox-small.xml");
    const std::string reference_path = test::shared_scene("cbox/reference/cbox-small.exr");
    if (path.empty() || reference_path.empty())
        GTEST_SKIP() << "../shared/scenes/cbox is absent: nothing to compare with";
    const LoadedScene loaded = load_scene(path, {}, false);
    Job job;
    apply_layer(job, loaded.settings);
    job.budget.spp = 252;
    job.sampler.seed = 11;
    job.integrator.next_event = NextEvent::always;
    job.guiding.type = GetParam();
    job.guiding.combination = Combination::fixed;
    const test::LocalRender run = test::render_locally(loaded.scene, job);

    const ExrRgb reference = read_exr_rgb(reference_path);
    RgbImage mean(loaded.scene.film.width, loaded.scene.film.height), variance = mean, reference_variance = mean;
    for (std::size_t p = 0; p < mean.pixels.size(); ++p) {
        mean.pixels[p] = Rgb(run.image.mean[p]);
        variance.pixels[p] = Rgb(run.image.variance[p]);
        reference_variance.pixels[p] = Rgb(run.image.variance[p] * (252.0 / 8192.0));  // the same estimator, 8,192 spp
    }
    ZTestInput input{mean, reference.image, &variance, &reference_variance};
    input.reference_half = reference.half;
    const BlockZTest blocks = block_z_test(input);
    const PixelZTest pixels = pixel_z_test(input);
    EXPECT_TRUE(blocks.pass) << "worst block z " << blocks.max_abs_z;
    EXPECT_LT(blocks.mean_z2, 1.6);
    EXPECT_TRUE(pixels.pass) << pixels.accepted << " of " << pixels.tests;
    EXPECT_NEAR(measure_error(mean, reference.image).mean_ratio, 1.0, 0.005);
}

INSTANTIATE_TEST_SUITE_P(Guiding, CornellReference, ::testing::Values(GuidingType::none, GuidingType::ppg));

}  // namespace
}  // namespace treefarm
