// The sampling form of the tree against the plain one, and its codec.
#include "common/guiding/guide.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/random_tree.h"

namespace treefarm {
namespace {

class GuideTest : public ::testing::Test {
  protected:
    SdTree tree = test::random_tree(4, 50000, 2000, 2);
    Guide guide{tree};
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
        const Guide::Sample s = guide.sample(r, bits(), bits(), bits());
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
                const Guide::Sample s = guide.sample(r, pick, u, u);
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
    const Guide again(decoded);
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
            const Guide still_a_tree(decode_tree(bad));  // what passes every check can be used
        } catch (const FormatError&) {
        }
    }
}

}  // namespace
}  // namespace treefarm
