// SPDX-License-Identifier: Apache-2.0
// A furnace to the last digits: what leaks or drifts in 10^6 samples shows.
#include "tests/support/hard_case.h"
#include "tests/support/test_scenes.h"

namespace treefarm {
namespace {

TEST(Furnace, AMillionSamplesAreExactInEveryPixel) {
    Scene scene = test::furnace(0.5f, 1.0f, 2.0f, Vec3(0.3f, -0.2f, 0.1f));
    test::set_film(scene, 3, 3);
    const test::LocalRender run = test::render_locally(scene, test::plain_job(1'000'000, 24));  // 0.5^24 < 1e-7
    EXPECT_EQ(test::invalid_samples(run), 0u);
    test::Worst worst;
    for (std::size_t i = 0; i < run.image.mean.size(); ++i)
        worst.see(std::abs(run.image.mean[i].x / 2.0 - 1.0), i);
    EXPECT_LT(worst.value, 1e-5) << worst.where;
    test::figure("largest relative error of a pixel", worst.value);
}

}  // namespace
}  // namespace treefarm
