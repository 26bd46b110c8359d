// SPDX-License-Identifier: Apache-2.0
// Spatial trees of scenes without extent, of coincident points, and of extreme light.
#include <random>

#include "common/base/policy.h"
#include "common/guiding/regions/mixture.h"
#include "common/guiding/sd_tree/refine.h"
#include "common/guiding/statistics/cell_accumulator.h"
#include "tests/support/hard_case.h"
#include "tests/support/test_scenes.h"

namespace treefarm {
namespace {

std::uint64_t mass_of(const SdTree& tree, std::uint32_t region) {
    std::uint64_t sum = 0;
    for (std::uint32_t c = tree.cell_begin[region]; c < tree.cell_begin[region + 1]; ++c)
        sum += tree.cell_mass[c];
    return sum;
}

/// 35 | 10^7 records at one point
/// Others: the spatial tree has no depth limit, so that each refinement adds levels around the point until regions
/// are smaller than a step of float (practical-path-guiding).
/// Here: at most 60 halvings, 20 of each axis; what would split further is counted.
/// Holds: ten passes of 10^7 records at one point (inside, at a corner, outside the cube) leave at most 61 x 8
/// regions that tile the cube, the limit is reached and counted, and the point is found in a region 2^-20 wide.
TEST(Trees, TenMillionRecordsAtOnePoint) {
    std::size_t most = 0;
    for (const Vec3& point : {Vec3(0.3f, 0.6f, 0.7f), Vec3(0.0f), Vec3(1.0f), Vec3(0.5f), Vec3(5.0f, -3.0f, 0.5f)}) {
        SdTree tree = initial_tree(Box3(Vec3(0.0f), Vec3(1.0f)), 1.0f);
        RefineReport report;
        for (int pass = 0; pass < 10; ++pass) {
            const SdTreeSampler guide(tree);
            const std::uint32_t region = guide.region(point);
            CellSums sums(tree.pass, tree.region_count(), tree.cell_count());
            sums.add_count(region, 10'000'000);
            sums.add_quanta(guide.cell(region, 12345u), 10'000'000);
            // Nothing else was recorded: regions split by half their weight each.
            tree = refine(tree, sums, {.spatial_threshold = 1.5e6}, report);
        }
        most = std::max<std::size_t>(most, tree.region_count());
        EXPECT_EQ(report.spatial_depth, kMaxSpatialDepth < 10 * 3 ? kMaxSpatialDepth : 30);
        const SdTreeSampler guide(tree);
        EXPECT_EQ(guide.region(point), guide.region(point + Vec3(1e-9f)));
        for (std::uint32_t r = 0; r < tree.region_count(); ++r)
            ASSERT_EQ(mass_of(tree, r), std::uint64_t{1} << kMassBits);
    }
    EXPECT_LT(most, 61u * 8u);

    // In one pass with a threshold of a single record: all the levels that there are, along every branch.
    const SdTree first = initial_tree(Box3(Vec3(0.0f), Vec3(1.0f)), 1.0f);
    SdTree tree = first;
    RefineReport report;
    for (int pass = 0; pass < 12; ++pass) {
        const SdTreeSampler guide(tree);
        const std::uint32_t region = guide.region(Vec3(0.3f, 0.6f, 0.7f));
        CellSums sums(tree.pass, tree.region_count(), tree.cell_count());
        sums.add_count(region, 64);
        tree = refine(tree, sums, {.spatial_threshold = 1.5}, report);
    }
    EXPECT_EQ(report.spatial_depth, kMaxSpatialDepth);
    EXPECT_GT(report.spatial_depth_capped, 0u);
    test::figure("regions around the point, at most", static_cast<double>(most));
}

/// 35 | Scenes of no extent: points, lines, planes
/// Others: a box of no size was divided by (practical-path-guiding, dTreeWrapper).
/// Here: the tree's cube has the longest edge of the scene's box; 1 where there is none.
/// Holds: for boxes that are empty, a point, a line, a plane, at 1e-30, 1 and 1e17 from the origin, the cube's edge
/// is above 0 and finite, every point of the box is in the tree, and guided renders of one triangle and of one
/// axis-aligned quad have no invalid sample and the right mean within 4.5 standard errors.
TEST(Trees, ScenesWithoutExtent) {
    test::Worst worst;
    const LetFloatsBe hostile;  // numbers that are none come in
    for (const float at : {0.0f, 1e-30f, 1.0f, 1e17f})
        for (const float size : {0.0f, 1e-30f, 1.0f, 1e17f})
            for (int axes = 0; axes < 8; ++axes) {
                const Vec3 low(at);
                const Vec3 high = low + Vec3(axes & 1 ? size : 0.0f, axes & 2 ? size : 0.0f, axes & 4 ? size : 0.0f);
                const SdTree tree = initial_tree(Box3(low, high), 1.0f);
                ASSERT_TRUE(tree.extent > 0.0f && std::isfinite(tree.extent)) << at << " " << size;
                const SdTreeSampler guide(tree);
                ASSERT_TRUE(guide.contains(low) && guide.contains(high)) << low << high;
                ASSERT_EQ(guide.region(low), 0u);
            }
    EXPECT_GT(initial_tree(Box3(), 1.0f).extent, 0.0f);

    for (const bool triangle : {true, false}) {
        Scene scene;
        const std::int32_t white = test::add_diffuse(scene, Rgb(0.5f), true);
        Mesh mesh = test::quad({-50, -50, 1}, {100, 0, 0}, {0, 100, 0});
        if (triangle) mesh.indices.resize(3);
        test::add_shape(scene, mesh, white);
        scene.emitters.push_back({ConstantEmitter{Rgb(1.0f)}, {}});
        scene.camera = test::look_at({2, -2, 1.0f + 1e-3f}, {2.001f, -2, 1}, {0, 1, 0}, 0.1f);
        test::set_film(scene, 8, 8);
        const test::LocalRender run = test::render_locally(scene, test::guided_job(63, 10, NextEvent::always));
        EXPECT_EQ(test::invalid_samples(run), 0u);
        const test::ImageMean mean = test::mean_of(run.image);
        EXPECT_NEAR(mean.value, 0.5, 4.5 * mean.error + 1e-5);
        worst.see(std::abs(mean.value / 0.5 - 1.0), triangle);
    }
    test::figure("largest relative error of the mean", worst.value);
}

/// 36 | Positions outside the tree's cube
/// Others: points outside the box of the scene read beyond the tree (Cycles #158755).
/// Here: they belong to the nearest region, and are counted.
/// Holds: for points up to infinity and NaN the region exists, is that of the nearest point of the cube, and
/// contains() is false; jittered by any random numbers too.
TEST(Trees, PositionsOutsideTheCube) {
    const LetFloatsBe hostile;  // numbers that are none come in
    SdTree tree = initial_tree(Box3(Vec3(0.0f), Vec3(1.0f)), 1.0f);
    CellSums sums(0, 1, 256);
    sums.add_count(0, 4096);
    RefineReport report;
    tree = refine(tree, sums, {.spatial_threshold = 8.0}, report);
    const SdTreeSampler guide(tree);
    ASSERT_EQ(guide.region_count(), 512u);
    int positions = 2;
    std::mt19937 random(1);
    const float values[] = {-test::kInfinity, -3e38f, -1.0f, 0.3f, 0.9f, 2.0f, 3e38f, test::kInfinity};
    for (const float x : values)
        for (const float y : values)
            for (const float z : values) {
                const Vec3 p(x, y, z),
                    nearest(std::clamp(x, 0.0f, 1.0f), std::clamp(y, 0.0f, 1.0f), std::clamp(z, 0.0f, 1.0f));
                const std::uint32_t region = guide.region(p);
                ASSERT_EQ(region, guide.region(nearest)) << p;
                ASSERT_EQ(guide.contains(p), p == nearest) << p;
                ++positions;
                const Draw draw = {static_cast<std::uint32_t>(random()), 0u, 0xffffffffu, 1u};
                ASSERT_LT(guide.region(guide.jittered(p, region, draw)), 512u);
            }
    for (const Vec3& p : {Vec3(test::kNan), Vec3(0.5f, test::kNan, 0.5f)}) {
        EXPECT_LT(guide.region(p), 512u);
        EXPECT_FALSE(guide.contains(p));
    }
    test::figure("positions in their nearest region", positions);
}

/// 18, 35 | One texel of 1e6
/// Others: one hot texel ruled every region, or was never found.
/// Here: the environment is sampled by its luminance, records are capped in quanta of the region, never in
/// radiance.
/// Holds: guided with next event, a floor under a map that is black but for one texel of 1e6 is as bright as the
/// unguided one within 4.5 standard errors, each of them within 2 % of the integral over the map.
TEST(Trees, OneTexelOfAMillion) {
    Scene scene;
    const std::int32_t white = test::add_diffuse(scene, Rgb(0.8f), true);
    test::add_shape(scene, test::quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}), white);
    TextureImage image;
    image.width = 256;
    image.height = 128;
    image.floats.assign(3 * 256 * 128, 0.0f);
    for (int c = 0; c < 3; ++c)
        image.floats[static_cast<std::size_t>(3 * (20 * 256 + 77) + c)] = 1e6f;
    scene.images.push_back(image);
    EnvironmentEmitter sky;
    sky.image = 0;
    scene.emitters.push_back({sky, {}});
    scene.camera = test::look_at({0, 0.6f, 0.01f}, {0, 0, 0}, {0, 0, 1}, 0.3f);
    test::set_film(scene, 12, 12);
    // The tent about the texel's centre: its solid angle times the cosine with the floor, over pi.
    const double theta = M_PI * 20.5 / 128;
    const double exact = 0.8 / M_PI * 1e6 * (2 * M_PI / 256) * (M_PI / 128) * std::sin(theta) * std::cos(theta);
    for (const bool guided : {false, true}) {
        const Job job = guided ? test::guided_job(63, 4, NextEvent::always) : test::plain_job(63, 4, NextEvent::always);
        const test::LocalRender run = test::render_locally(scene, job);
        EXPECT_EQ(test::invalid_samples(run), 0u);
        const test::ImageMean mean = test::mean_of(run.image);
        EXPECT_NEAR(mean.value / exact, 1.0, 4.5 * mean.error / exact + 0.005) << guided;
        if (guided) test::figure("guided mean over the integral", mean.value / exact);
    }
}

/// 34 | Mixture histograms of one bin, and of densities 0 and infinite
/// Others: Adam's fraction ran into its limits, and gradients were NaN where a density was 0
/// (practical-path-guiding).
/// Here: histograms that merge, a concave objective with a prior, bisection within [0.05, 1].
/// Holds: all energy in any one bin, at scales 1e-300 to 1e300, with priors 0.05 to 1 and weights 0 to 1e300, gives
/// a fraction in [0.05, 1]; above 1/2 in the upper bins, below in the lower; pairs of densities 0, tiny, huge and
/// infinite all have a bin.
TEST(Trees, MixturesOfOneBin) {
    const LetFloatsBe hostile;  // numbers that are none come in
    double least = 1.0;
    for (int bin = 0; bin < kMixtureBins; ++bin)
        for (const double scale : {1e-300, 1e-30, 1.0, 1e30, 1e300})
            for (const double prior : {tuned("learning.least_bsdf_fraction"), 0.5, 1.0})
                for (const double weight : {0.0, 1e-300, 1.0, 1e300}) {
                    MixtureHistogram histogram{};
                    histogram[static_cast<std::size_t>(bin)] = scale;
                    const double a = best_bsdf_fraction(histogram, prior, weight);
                    least = std::min(least, a);
                    ASSERT_TRUE(a >= tuned("learning.least_bsdf_fraction") && a <= 1.0)
                        << bin << " " << scale << " " << a;
                    if (weight == 0.0) {
                        ASSERT_EQ(a > 0.5, bin >= kMixtureBins / 2) << bin << " " << a;
                    }
                }
    const float densities[] = {0.0f, 1e-45f, 1e-30f, 1.0f, 1e30f, 3e38f, test::kInfinity};
    for (const float bsdf : densities)
        for (const float tree : densities)
            EXPECT_LT(mixture_bin(bsdf, tree), kMixtureBins) << bsdf << " " << tree;
    EXPECT_EQ(mixture_bin(test::kInfinity, test::kInfinity), 0);
    test::figure("least fraction", least);
}

/// 34 | Mixtures where nothing has energy
/// Others: [ours] the share of one tree among two was 0/0 where neither had a density; the result was discarded.
/// Here: what is without density has the first bin, before anything is divided.
/// Holds: all pairs of the densities 0, 1e-30, 1 and 1e30 have a bin, the first one where the BSDF's is 0, without an
/// invalid operation in the trapped build.
TEST(Trees, MixturesWithoutEnergy) {
    const float densities[] = {0.0f, 1e-30f, 1.0f, 1e30f};
    int pairs = 0;
    for (const float bsdf : densities)
        for (const float tree : densities) {
            const int bin = mixture_bin(bsdf, tree);
            ASSERT_LT(bin, kMixtureBins) << bsdf << " " << tree;
            if (bsdf == 0.0f) {
                ASSERT_EQ(bin, 0) << tree;
            }
            ++pairs;
        }
    test::figure("pairs of densities", pairs);
}

}  // namespace
}  // namespace treefarm
