// SPDX-License-Identifier: Apache-2.0
// The sampling form of the tree against the plain one, and its codec.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "common/guiding/sd_tree/sd_tree_sampler.h"
#include "tests/support/random_tree.h"

namespace treefarm {
namespace {

class GuideTest : public ::testing::Test {
  protected:
    SdTree tree = test::random_tree(4, 50000, 2000, 2);
    SdTreeSampler guide{tree};
    std::mt19937 engine{5};
    std::uniform_real_distribution<float> uniform{0.0f, 1.0f};

    std::uint32_t bits() { return static_cast<std::uint32_t>(engine()); }

    /// The region by walking the plain tree.
    std::uint32_t slow_region(const Vec3& p) const {
        std::uint32_t node = 0;
        Vec3 low = tree.origin;
        Vec3 size(tree.extent);
        for (int axis = 0; !tree.nodes[node].is_leaf(); axis = (axis + 1) % 3) {
            size[axis] *= 0.5f;
            const bool upper = p[axis] >= low[axis] + size[axis];
            if (upper) low[axis] += size[axis];
            node = tree.nodes[node].child[upper];
        }
        return tree.nodes[node].child[1];
    }
};

TEST_F(GuideTest, FindsTheSameRegionsAsThePlainTree) {
    EXPECT_GT(guide.region_count(), 20u);
    for (int i = 0; i < 20000; ++i) {
        const Vec3 p(uniform(engine), uniform(engine), uniform(engine));
        EXPECT_EQ(guide.region(p), slow_region(p));
    }
}

/// Halved towards the origin again and again, down to the deepest region that there may be.
SdTree deep_tree() {
    SdTree tree = initial_tree(Box3(Vec3(0.0f), Vec3(1.0f)), 1.0f);
    const std::size_t cells = tree.cell_depth.size();
    const std::vector<std::uint8_t> depths = tree.cell_depth;
    const std::vector<std::uint32_t> masses = tree.cell_mass;
    const auto leaf = [](std::uint32_t region) { return SdTree::Node{{0, region}}; };
    tree.nodes.clear();
    for (std::uint32_t level = 0; level < kMaxSpatialDepth; ++level) {
        const auto next = 2 * level + 1;  // its leaf, then the next to be halved
        tree.nodes.push_back({{next + 1, next}});
        tree.nodes.push_back(leaf(level));
    }
    tree.nodes.push_back(leaf(kMaxSpatialDepth));
    for (int region = 0; region < kMaxSpatialDepth; ++region) {
        tree.cell_depth.insert(tree.cell_depth.end(), depths.begin(), depths.end());
        tree.cell_mass.insert(tree.cell_mass.end(), masses.begin(), masses.end());
        tree.cell_begin.push_back(tree.cell_begin.back() + static_cast<std::uint32_t>(cells));
        tree.quantum_exponent.push_back(tree.quantum_exponent.front());
        tree.bsdf_fraction.push_back(tree.bsdf_fraction.front());
    }
    return tree;
}

/// In step, the first of a batch, shallow and deep ones mixed.
TEST_F(GuideTest, RegionsOfABatchAreThoseOfItsPoints) {
    tree = deep_tree();
    const SdTreeSampler deep(tree);
    VectorBatch points{};
    std::array<std::uint32_t, kDrawBatch> found;
    std::uint32_t deepest = 0;
    for (const std::uint32_t count : {0u, 1u, 7u, 33u, kDrawBatch}) {
        for (int round = 0; round < 200; ++round) {
            for (std::uint32_t i = 0; i < count; ++i) {
                const float scale = std::ldexp(1.0f, -static_cast<int>(bits() % 24));
                points.set(
                    i, tree.origin + Vec3(uniform(engine), uniform(engine), uniform(engine)) * (scale * tree.extent));
            }
            if (count > 2) {
                points.set(1, Vec3(std::nanf("")));
                points.set(2, Vec3(1e30f, -1e30f, 0.5f));
            }
            deep.regions(points, count, found);
            for (std::uint32_t i = 0; i < count; ++i) {
                ASSERT_EQ(found[i], deep.region(points[i]));
                if (deep.contains(points[i])) {
                    ASSERT_EQ(found[i], slow_region(points[i]));
                }
                deepest = std::max(deepest, found[i]);
            }
        }
    }
    EXPECT_EQ(deepest, static_cast<std::uint32_t>(kMaxSpatialDepth));
}

TEST_F(GuideTest, PointsOutsideBelongToTheNearestRegion) {
    EXPECT_EQ(guide.region({-5.0f, 0.3f, 0.3f}), guide.region({0.0f, 0.3f, 0.3f}));
    EXPECT_EQ(guide.region({0.3f, 9.0f, 0.3f}), guide.region({0.3f, 0.99999f, 0.3f}));
    EXPECT_LT(guide.region({std::nanf(""), std::nanf(""), std::nanf("")}), guide.region_count());
    EXPECT_FALSE(guide.contains({-5.0f, 0.3f, 0.3f}));
    EXPECT_TRUE(guide.contains({1.0f, 0.0f, 1.0f}));
    EXPECT_FALSE(guide.contains({std::nanf(""), 0.0f, 0.0f}));
}

TEST_F(GuideTest, FindsTheCellThatHoldsACode) {
    for (std::uint32_t r = 0; r < guide.region_count(); ++r) {
        std::uint64_t code = 0;
        for (std::uint32_t c = tree.cell_begin[r]; c < tree.cell_begin[r + 1]; ++c) {
            const std::uint64_t size = std::uint64_t{1} << (2 * (kDirectionBits - tree.cell_depth[c]));
            EXPECT_EQ(guide.cell(r, static_cast<std::uint32_t>(code)), c);
            EXPECT_EQ(guide.cell(r, static_cast<std::uint32_t>(code + size - 1)), c);
            const double density =
                static_cast<double>(tree.cell_mass[c]) / static_cast<double>(size) * 4 * 0.07957747154594766788;
            EXPECT_NEAR(guide.pdf(r, static_cast<std::uint32_t>(code)), density, 1e-6 * density);
            code += size;
        }
        EXPECT_EQ(code, std::uint64_t{1} << 32);
    }
}

TEST_F(GuideTest, SamplesLieInTheCellWhoseDensityTheyReport) {
    for (int i = 0; i < 200000; ++i) {
        const std::uint32_t r = bits() % guide.region_count();
        const SdTreeSampler::Sample s = guide.sample(r, bits(), bits(), bits());
        ASSERT_GT(s.pdf, 0.0f);
        ASSERT_EQ(s.pdf, guide.pdf(r, s.code));
        ASSERT_NEAR(dot(s.direction, s.direction), 1.0f, 1e-5f);
        // Mapping the direction back lands in the same place of the square, up to rounding.
        const Vec2 p = direction_to_square(s.direction);
        const float x = static_cast<float>(compact_bits(s.code)) / 65536.0f,
                    y = static_cast<float>(compact_bits(s.code >> 1)) / 65536.0f;
        ASSERT_NEAR(p.x, x, 3e-5f);
        ASSERT_NEAR(p.y, y, 3e-5f);
    }
}

TEST_F(GuideTest, ExtremeRandomNumbersAreFine) {
    for (std::uint32_t r = 0; r < guide.region_count(); ++r)
        for (const std::uint32_t pick : {0u, 0xffffffffu})
            for (const std::uint32_t u : {0u, 0xffffffffu}) {
                const SdTreeSampler::Sample s = guide.sample(r, pick, u, u);
                EXPECT_GT(s.pdf, 0.0f);
                EXPECT_EQ(s.pdf, guide.pdf(r, s.code));
            }
}

TEST_F(GuideTest, CodecKeepsTheTree) {
    const Bytes bytes = encode_tree(tree);
    const SdTree decoded = decode_tree(bytes);
    EXPECT_EQ(decoded.pass, tree.pass);
    EXPECT_EQ(decoded.trained, tree.trained);
    EXPECT_EQ(decoded.cell_begin, tree.cell_begin);
    EXPECT_EQ(decoded.cell_depth, tree.cell_depth);
    EXPECT_EQ(decoded.cell_mass, tree.cell_mass);
    EXPECT_EQ(decoded.quantum_exponent, tree.quantum_exponent);
    EXPECT_EQ(encode_tree(decoded), bytes);
    const SdTreeSampler again(decoded);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 p(uniform(engine), uniform(engine), uniform(engine));
        EXPECT_EQ(again.region(p), guide.region(p));
    }
}

TEST_F(GuideTest, UnitsOfRecordsBeyondAnyMeanAreRefused) {
    for (const int exponent : {-kMostQuantumExponent, kMostQuantumExponent}) {
        SdTree far = tree;
        far.quantum_exponent[0] = static_cast<std::int16_t>(exponent);
        EXPECT_EQ(decode_tree(encode_tree(far)).quantum_exponent[0], exponent);
        far.quantum_exponent[0] = static_cast<std::int16_t>(exponent < 0 ? exponent - 1 : exponent + 1);
        EXPECT_THROW(decode_tree(encode_tree(far)), FormatError);
    }
}

TEST_F(GuideTest, DamagedBytesAreRefused) {
    const Bytes bytes = encode_tree(test::random_tree(2, 2000, 500, 3));
    for (std::size_t size = 0; size < bytes.size(); ++size)
        EXPECT_THROW(decode_tree(std::span(bytes).first(size)), FormatError);
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        Bytes bad = bytes;
        bad[i] = static_cast<std::uint8_t>(bad[i] ^ 0x55);
        try {
            const SdTreeSampler still_a_tree(decode_tree(bad));  // what passes every check can be used
        } catch (const FormatError&) {
        }
    }
}

}  // namespace
}  // namespace treefarm
