// SPDX-License-Identifier: Apache-2.0
// Frames, maps of directions, and the quadtrees over them at their seams, poles and depth limits.
#include <random>

#include "common/guiding/sd_tree/refine.h"
#include "common/guiding/sd_tree/sd_tree_sampler.h"
#include "common/math/direction_map.h"
#include "common/math/frame.h"
#include "common/math/warp_batch.h"
#include "tests/support/hard_case.h"

namespace treefarm {
namespace {

/// 11 | The orthonormal frame towards -z
/// Others: Frisvad's construction loses all digits there (Duff et al. 2017); summaries of the cure carry wrong
/// code.
/// Here: Duff's construction, with the sign of z copied so that -0 counts as negative.
/// Holds: for normals within 2000 steps of float around both poles, and -0, the axes are unit and at right angles
/// within 1e-6 and the determinant is 1 within 1e-6.
TEST(Directions, FramesTowardsThePoles) {
    test::Worst worst;
    const auto look = [&](const Vec3& n) {
        const Frame f(n);
        ASSERT_TRUE(is_finite(f.s) && is_finite(f.t)) << n;
        const auto d = [](const Vec3& a, const Vec3& b) { return Imath::V3d(a).dot(Imath::V3d(b)); };
        for (const double error : {d(f.s, f.s) - 1, d(f.t, f.t) - 1, d(f.s, f.t), d(f.s, n), d(f.t, n),
                                   Imath::V3d(f.s).cross(Imath::V3d(f.t)).dot(Imath::V3d(n)) - 1})
            worst.see(std::abs(error), n);
    };
    for (const float pole : {1.0f, -1.0f})
        for (const float turn : {0.0f, 1.0f, 0.6f, -0.8f}) {
            float sine = 0.0f;
            for (int i = 0; i < 2000; ++i, sine = std::nextafter(sine, 1.0f) * 1.05f) {
                if (sine > 0.01f) break;
                const float x = sine * turn, y = sine * std::sqrt(std::max(0.0f, 1.0f - turn * turn));
                look(Vec3(x, y, pole * std::sqrt(1.0f - sine * sine)));
            }
        }
    for (const float x : {1.0f, -1.0f, 0.0f, -0.0f})
        for (const float z : {0.0f, -0.0f}) {
            look(normalize(Vec3(x, 1.0f, z)));
            look(normalize(Vec3(x, -1.0f, z)));
        }
    EXPECT_LT(worst.value, 1e-6) << worst.where;
    test::figure("largest error of an axis", worst.value);
}

/// Directions on seams, poles, edges of octants, and next to them.
std::vector<Vec3> seam_directions() {
    std::vector<Vec3> all;
    const float values[] = {0.0f, -0.0f, 1e-45f, -1e-45f, 1e-30f, 1e-8f, -1e-8f, 1e-4f, 0.5f, -0.5f, 1.0f, -1.0f};
    for (const float x : values)
        for (const float y : values)
            for (const float z : values)
                if (std::max({std::abs(x), std::abs(y), std::abs(z)}) >= 0.5f) all.push_back(normalize(Vec3(x, y, z)));
    return all;
}

/// 30 | Directions on the map's seams and poles
/// Others: an azimuth of 2 pi, a cosine of 1 and -0 fell outside the square or into a loop, NaN became a valid
/// corner (practical-path-guiding, dirToCanonical).
/// Here: the octahedral map ends below 1, has no loop, and one function serves single directions and batches.
/// Holds: on all seams the square's coordinates are in [0, 1), mapping there and back moves a direction by at most
/// 2e-6, batches give the same codes, and a direction that is no number gets some cell without leaving the tree.
TEST(Directions, OnSeamsAndPoles) {
    const LetFloatsBe hostile;  // numbers that are none come in
    test::Worst worst;
    for (const Vec3& d : seam_directions()) {
        const Vec2 p = direction_to_square(d);
        ASSERT_TRUE(p.x >= 0.0f && p.x < 1.0f && p.y >= 0.0f && p.y < 1.0f) << d << p;
        worst.see(double((square_to_direction(p) - d).length()), d);
        VectorBatch batch;
        for (std::size_t i = 0; i < 8; ++i)
            batch.set(i, d);
        std::array<std::uint32_t, kDrawBatch> codes;
        direction_to_code_batch(batch, 1, codes);
        ASSERT_EQ(codes[0], direction_to_code(d)) << d;
    }
    EXPECT_LT(worst.value, 2e-6) << worst.where;
    const SdTreeSampler guide(initial_tree(Box3(Vec3(0.0f), Vec3(1.0f)), 1.0f));
    for (const Vec3& bad : {Vec3(test::kNan), Vec3(0.0f, test::kNan, 1.0f), Vec3(test::kInfinity), Vec3(0.0f)})
        EXPECT_LT(guide.cell(0, direction_to_code(bad)), 256u);
    test::figure("largest movement of a direction", worst.value);
}

/// A tree of one region whose energy is all within one cell of the deepest level: `passes` refinements towards `code`.
SdTree deep_tree(std::uint32_t code, int passes, RefineReport& report) {
    SdTree tree = initial_tree(Box3(Vec3(0.0f), Vec3(1.0f)), 1.0f);
    for (int pass = 0; pass < passes; ++pass) {
        CellSums sums(tree.pass, tree.region_count(), tree.cell_count());
        sums.add_quanta(SdTreeSampler(tree).cell(0, code), 1'000'000);
        for (std::uint32_t c = 0; c < tree.cell_count(); c += 7)
            sums.add_quanta(c, 3);
        sums.add_count(0, 100);
        tree = refine(tree, sums, {.spatial_threshold = 1e18}, report);
    }
    return tree;
}

/// 31 | Quadtrees at their depth limit
/// Others: a coordinate doubled 20 times in float, so that sampling and density disagreed (practical-path-guiding).
/// Here: cells are ranges of an integer code, probabilities integers that sum to 2^30; sampling and density read
/// one table. Cells end at 4^-16 of the sphere, and what would split further is counted.
/// Holds: with all energy at one direction (poles, corners, random), densities times areas sum to 1 within 1e-6,
/// the limit is reached and counted, and 20,000 samples have exactly the density of the cell that they lie in.
TEST(Directions, QuadtreesAtTheirDepthLimit) {
    std::mt19937 random(1);
    test::Worst worst;
    std::vector<std::uint32_t> codes = {0u,
                                        0xffffffffu,
                                        0x55555555u,
                                        0xaaaaaaaau,
                                        direction_to_code({0, 0, 1}),
                                        direction_to_code({0, 0, -1}),
                                        direction_to_code({1, 0, 0})};
    for (int i = 0; i < 5; ++i)
        codes.push_back(static_cast<std::uint32_t>(random()));
    for (const std::uint32_t code : codes) {
        RefineReport report;
        const SdTree tree = deep_tree(code, 20, report);
        EXPECT_EQ(report.directional_depth, kMaxDirectionDepth);
        EXPECT_GT(report.directional_depth_capped, 0u);
        const SdTreeSampler guide(tree);
        double sum = 0;
        std::uint64_t begin = 0, mass = 0;
        for (const std::uint32_t m : tree.cell_mass)
            mass += m;
        ASSERT_EQ(mass, std::uint64_t{1} << kMassBits);
        for (std::uint32_t c = 0; c < tree.cell_count(); ++c) {
            const std::uint64_t size = std::uint64_t{1} << (2 * (kDirectionBits - tree.cell_depth[c]));
            sum += double(guide.pdf(0, static_cast<std::uint32_t>(begin))) * 4 * M_PI * double(size) * 0x1p-32;
            begin += size;
        }
        worst.see(std::abs(sum - 1.0), code);
        ASSERT_EQ(begin, std::uint64_t{1} << 32);
        for (int i = 0; i < 20000; ++i) {
            const auto u = [&] { return static_cast<std::uint32_t>(random()); };
            const SdTreeSampler::Sample s = guide.sample(0, u(), u(), u());
            ASSERT_EQ(s.pdf, guide.pdf(0, s.code)) << code;
            ASSERT_GT(s.pdf, 0.0f);
        }
        EXPECT_GT(guide.pdf(0, code), 1e7f) << "nearly all of it within 4^-16 of the sphere";
    }
    EXPECT_LT(worst.value, 1e-6) << worst.where;
    test::figure("sum of densities times areas minus 1", worst.value);
}

/// 29 | Regions and cells without energy
/// Others: a leaf of zero weight divided 0 by 0; a mean of 0 had to become the uniform density.
/// Here: a region without energy spreads evenly; a cell without energy has density 0, which the BSDF's share
/// covers.
/// Holds: without energy all 256 cells have 1/(4 pi) exactly; with energy in one cell all samples lie in it and
/// other cells have density 0; a mixture's density stays above 0 wherever the BSDF's is.
TEST(Directions, CellsWithoutEnergy) {
    const SdTree first = initial_tree(Box3(Vec3(0.0f), Vec3(1.0f)), 1.0f);
    CellSums sums(0, 1, 256);
    sums.add_count(0, 1000);
    RefineReport report;
    const SdTree even = refine(first, sums, {.spatial_threshold = 1e18}, report);
    const SdTreeSampler even_guide(even);
    ASSERT_EQ(even_guide.cell_count(), 256u);
    for (std::uint32_t c = 0; c < 256; ++c)
        ASSERT_EQ(even_guide.pdf(0, c << 24), kInvFourPi);

    sums.add_quanta(17, 1);
    const SdTree one = refine(first, sums, {.spatial_threshold = 1e18}, report);
    const SdTreeSampler guide(one);
    std::mt19937 random(3);
    for (int i = 0; i < 10000; ++i) {
        const auto u = [&] { return static_cast<std::uint32_t>(random()); };
        ASSERT_EQ(guide.sample(0, u(), u(), u()).code >> 24, 17u);
    }
    for (std::uint32_t c = 0; c < 256; ++c)
        ASSERT_EQ(guide.pdf(0, c << 24) > 0.0f, c == 17) << c;
    test::figure("largest density of a cell without energy", double(guide.pdf(0, 18u << 24)));
}

}  // namespace
}  // namespace treefarm
