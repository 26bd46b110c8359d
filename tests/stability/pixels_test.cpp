// SPDX-License-Identifier: Apache-2.0
// What pixels make of extreme, rare and very many samples.
#include <filesystem>
#include <random>

#include "common/film/pass_film.h"
#include "common/image/exr.h"
#include "common/plan/schedule/schedule.h"
#include "tests/support/hard_case.h"
#include "tests/support/resolved.h"
#include "tests/support/test_folder.h"
#include "tests/support/test_scenes.h"
#include "worker/camera/camera_rays.h"
#include "worker/integrators/path/tile_kernel.h"

namespace treefarm {
namespace {

/// 9 | One bad sample in a pixel
/// Others: a NaN stayed in the accumulation buffer for ever (Q2RTX #23).
/// Here: the film's door counts what is negative, infinite or NaN as black, and keeps where it was.
/// Holds: of NaN, both infinities and a negative value in any channel all are refused, and counted; a pixel of 63
/// ones and one bad sample has the mean 63/64 exactly.
TEST(Pixels, OneBadSampleDoesNotPoison) {
    const LetFloatsBe hostile;  // numbers that are none come in
    double worst = 0;
    const WorkUnit unit{3, 0, 0, 1, 1, 0};
    for (const float bad : {test::kNan, test::kInfinity, -test::kInfinity, -1e-30f})
        for (int channel = 0; channel < 3; ++channel) {
            UnitStats stats;
            PixelEstimate pixel;
            for (std::uint32_t sample = 0; sample < 64; ++sample) {
                Rgb value(1.0f);
                if (sample == 17) value[channel] = bad;
                refuse_invalid(value, unit, 0, 0, sample, stats);
                pixel.add(sample, value);
            }
            EXPECT_EQ(stats.invalid_samples, 1u);
            ASSERT_EQ(stats.first_invalid.size(), 1u);
            EXPECT_EQ(stats.first_invalid[0].sample, 17u);
            for (int c = 0; c < 3; ++c) {
                EXPECT_NEAR(pixel.whole().mean[c], 63.0 / 64.0, 1e-14);
                worst = std::max(worst, std::abs(pixel.whole().mean[c] - 63.0 / 64.0));
            }
        }
    test::figure("largest error of the mean", worst);
}

/// 23, 27 | The mean of very many samples
/// Others: accumulation in float drifted (Mitsuba 3 afeefedc8), or stood still.
/// Here: double, in blocks of 64 samples that are merged along a fixed tree.
/// Holds: 2^31 samples of 1 + 1e-7 (as float) have that mean within 1e-13 and a variance below 1e-12; a mean of 1e6
/// with a deviation of 1 keeps its variance within 1 %.
TEST(Pixels, MeansOfVeryManySamples) {
    const float value = 1.0f + 1e-7f;
    PixelEstimate block;
    for (std::uint32_t i = 0; i < 64; ++i)
        block.add(i, Rgb(value));
    PixelEstimate whole = block;
    for (int doubling = 0; doubling < 25; ++doubling)
        whole = PixelEstimate::merge(whole, whole);
    const Moments all = whole.whole();
    EXPECT_EQ(all.n, 1u << 31);
    EXPECT_NEAR(double(all.mean.x), double(value), 1e-13);
    EXPECT_LT(double(all.sample_variance().x), 1e-12);

    std::mt19937 random(1);
    std::normal_distribution<double> normal(1e6, 1.0);
    std::vector<PixelEstimate> blocks(1000);
    for (std::uint32_t i = 0; i < 64'000; ++i)
        blocks[i / 64].add(i, Rgb(static_cast<float>(normal(random))));
    const double variance = double(reduce_blocks(blocks).whole().sample_variance().x);
    EXPECT_NEAR(variance, 1.0, 0.03);
    test::figure("error of the mean of 2^31 samples", std::abs(double(all.mean.x) - double(value)));
}

/// 25 | Counts beyond 31 bits
/// Others: pixels times passes times samples overflowed an int (pbrt 6aa009b7, Cycles 103301030, Mitsuba 3
/// 575b6c466).
/// Here: sample numbers have 32 bits, everything that multiplies them 64.
/// Holds: a schedule of 2^31 - 1 samples per pixel adds up, its units cover every block once, and the largest
/// film's last pixel and sample have a path of their own.
TEST(Pixels, CountsBeyond31Bits) {
    Job job;
    job.budget.spp = 0x7fffffffu;
    std::uint64_t sum = 0;
    for (const PassPlan& pass : plan_passes(test::resolved(job))) {
        EXPECT_EQ(pass.first_sample, sum);
        sum += pass.spp;
        const std::uint64_t blocks = (std::uint64_t{pass.spp} + kBlockSamples - 1) / kBlockSamples;
        EXPECT_GE(std::uint64_t{pass.chunks} * pass.blocks_per_unit, blocks);
        EXPECT_LT(std::uint64_t{pass.chunks - 1} * pass.blocks_per_unit, blocks);
    }
    EXPECT_GE(sum, 0x7fffffffu);
    EXPECT_LE(sum, 0xffffffffu);
    const PathKey last{0, 65535u * 65535u - 1u, 0xffffffffu};
    EXPECT_NE(draw(last, 1, Stream::scatter), draw({0, last.pixel, last.sample - 1}, 1, Stream::scatter));
    test::figure("samples per pixel in the schedule", static_cast<double>(sum));
}

/// 22 | Samples on the edges of pixels
/// Others: a sample at a whole coordinate went to two pixels or to none (Mitsuba 3 2d8976266).
/// Here: the filter is sampled: an offset belongs to its pixel whatever it is.
/// Holds: for the first and last random numbers rays of neighbouring pixels meet at their common edge within 1e-6
/// of a pixel, without gap or overlap.
TEST(Pixels, SamplesOnTheirEdges) {
    Scene scene;
    scene.camera = test::look_at({0, 0, 0}, {0, 0, 1}, {0, 1, 0}, 0.5f);
    test::set_film(scene, 64, 64);
    const CameraRays rays(scene.camera, scene.film);
    double worst = 0;
    for (int x = 0; x < 63; ++x) {
        const Draw first = {0u, 0x80000000u, 0u, 0u}, last = {0xffffffffu, 0x80000000u, 0u, 0u};
        const Vec3 end = rays.generate(x, 5, last).direction, begin = rays.generate(x + 1, 5, first).direction;
        worst = std::max(worst, double((end - begin).length()) * 64);
    }
    EXPECT_LT(worst, 2e-5);
    test::figure("distance of neighbouring pixels' edges, of a pixel", worst);
}

/// 24 | Radiance beyond half floats
/// Others: EXR files held infinity (pbrt 8c0e220b).
/// Here: images are written as float; where half is asked for, values end at 65504.
/// Holds: 1e6, 1e30 and 3e38 come back exactly as float, and as 65504 from half.
TEST(Pixels, RadianceBeyondHalf) {
    const std::filesystem::path folder = test::test_folder();
    Image image{3, 1, {}, {}};
    const auto y = image.add_channel("Y");
    y[0] = 1e6f;
    y[1] = 1e30f;
    y[2] = 3e38f;
    write_exr(folder / "float.exr", image);
    write_exr(folder / "half.exr", image, {}, PixelType::half);
    const ExrRgb exact = read_exr_rgb(folder / "float.exr"), half = read_exr_rgb(folder / "half.exr");
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(exact.image.pixels[i].x, y[i]);
        EXPECT_EQ(half.image.pixels[i].x, 65504.0f);
    }
    test::figure("1e30 as half", double(half.image.pixels[1].x));
}

PassResult pass_of(std::uint32_t spp, std::uint32_t before, float value, unsigned seed) {
    PassResult pass{spp, before, std::vector<PixelEstimate>(64)};
    std::mt19937 random(seed);
    std::exponential_distribution<float> noise(1.0f / value);
    for (PixelEstimate& pixel : pass.pixels)
        for (std::uint32_t i = 0; i < spp; ++i)
            pixel.add(before + i, Rgb(value > 0.0f ? noise(random) : 0.0f));
    return pass;
}

/// 28 | Combining passes of one sample
/// Others: the variance of one sample is 0/0: "Var: 1.#INF00" (practical-path-guiding's published log).
/// Here: fewer than two samples have no variance, and passes of fewer than four get no weight by it.
/// Holds: for every method, passes of 1, 1 + 1, 1 + 2 and 1 + 2 + 4 samples, noisy, black or as bright as 1e30,
/// have finite means, variances and weights; the weights sum to 1 within 1e-12; errors are known only where they
/// can be.
TEST(Pixels, PassesOfOneSample) {
    const LetFloatsBe hostile;  // numbers that are none come in
    double worst = 0;
    for (const Combination method : {Combination::inverse_variance, Combination::fixed, Combination::last})
        for (const bool guided : {false, true})
            for (const float value : {0.0f, 1e-30f, 1.0f, 1e30f})
                for (const std::vector<std::uint32_t>& lengths :
                     {std::vector<std::uint32_t>{1}, {1, 1}, {1, 2}, {1, 2, 4}, {4, 1}}) {
                    std::vector<PassResult> passes;
                    std::uint32_t before = 0;
                    for (const std::uint32_t spp : lengths) {
                        passes.push_back(pass_of(spp, before, value, before + 1));
                        before += spp;
                    }
                    const CombinedImage image = combine_passes(passes, method, guided);
                    for (std::size_t p = 0; p < image.mean.size(); ++p) {
                        ASSERT_TRUE(std::isfinite(image.mean[p].x) && image.mean[p].x >= 0.0);
                        ASSERT_TRUE(std::isfinite(image.variance[p].x) && image.variance[p].x >= 0.0);
                    }
                    double sum = 0;
                    for (const double w : image.weight) {
                        ASSERT_TRUE(std::isfinite(w));
                        sum += w;
                    }
                    ASSERT_NEAR(sum, 1.0, 1e-12);
                    worst = std::max(worst, std::abs(sum - 1.0));
                    for (const PassResult& pass : passes) {
                        const PassVariance v = pass_variance(pass.pixels);
                        ASSERT_TRUE(std::isfinite(v.stuv) && std::isfinite(v.stuv_ppg) &&
                                    std::isfinite(v.stuv_trimmed));
                    }
                }
    test::figure("sum of the weights minus 1, at most", worst);
}

}  // namespace
}  // namespace treefarm
