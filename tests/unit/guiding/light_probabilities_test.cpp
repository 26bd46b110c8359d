// SPDX-License-Identifier: Apache-2.0
// How next event learns to choose emitters: sums, what is made of them, and what is sent.
#include "common/guiding/regions/light_probabilities.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "common/base/error.h"
#include "common/guiding/sd_tree/sd_tree_sampler.h"
#include "common/guiding/sd_tree/tree_learner.h"
#include "common/guiding/statistics/cell_accumulator.h"

namespace treefarm {
namespace {

using Moments = std::array<double, kLightClusters>;

double part(const LightProbabilities& probabilities, int cluster) {
    return probabilities[static_cast<std::size_t>(cluster) + 1] / double(kLightProbabilityOne);
}

int sum(const LightProbabilities& probabilities) {
    return std::accumulate(probabilities.begin(), probabilities.end(), 0);
}

TEST(LightProbabilities, IsProportionalToTheRootOfTheSecondMoments) {
    Moments moments{};
    moments[1] = 4.0;
    moments[3] = 36.0;
    const LightProbabilities probabilities = learned_probabilities(moments, 1e9, kNothingLearned);
    EXPECT_EQ(sum(probabilities), kLightProbabilityOne);
    EXPECT_NEAR(part(probabilities, 3) / part(probabilities, 1), 3.0, 0.01);
    EXPECT_NEAR(part(probabilities, 1) + part(probabilities, 3), 0.8, 0.001)
        << "a fifth stays with the choice by power";
    EXPECT_EQ(part(probabilities, 0), 0.0);
}

TEST(LightProbabilities, AYoungRegionKeepsItsParents) {
    LightProbabilities parent{};
    parent[0] = kLightProbabilityOne / 4;
    parent[3] = 3 * (kLightProbabilityOne / 4);
    Moments moments{};
    moments[0] = 1.0;
    EXPECT_EQ(learned_probabilities(moments, 0, parent), parent);
    EXPECT_EQ(learned_probabilities(Moments{}, 1e6, parent), parent) << "nothing was found";
    const LightProbabilities half = learned_probabilities(moments, 128, parent);
    EXPECT_EQ(sum(half), kLightProbabilityOne);
    EXPECT_NEAR(part(half, 2), 0.375, 0.001);
    EXPECT_NEAR(part(half, 0), 0.4, 0.001);
}

TEST(LightProbabilities, AnyMomentsMakeProbabilities) {
    for (const double scale : {0.0, 1e-300, 1e-30, 1.0, 1e30, 1e300, 1e308})
        for (const double vertices : {0.0, 0.5, 1.0, 1e12}) {
            Moments moments{};
            for (std::size_t c = 0; c < moments.size(); ++c)
                moments[c] = scale * double(c % 4);
            EXPECT_EQ(sum(learned_probabilities(moments, vertices, kNothingLearned)), kLightProbabilityOne) << scale;
        }
}

/// An emitter's samples add as much on average, however often it is chosen.
TEST(LightProbabilities, TheSumsExpectationDoesNotDependOnTheChoice) {
    const int exponent = quantum_exponent_for(1.0f);
    const auto sum_of = [&](double chosen) {
        const float brought = static_cast<float>(0.3 / chosen);
        return 10000 * chosen * double(light_record(0, exponent, 2, static_cast<float>(chosen), brought).reflected);
    };
    EXPECT_NEAR(sum_of(0.01) / sum_of(1.0), 1.0, 1e-5);
    EXPECT_NEAR(std::ldexp(sum_of(0.25), light_sum_exponent(exponent)) / (10000 * 0.09), 1.0, 1e-5);
}

class LightLearning : public ::testing::Test {
  protected:
    static SdTree root() {
        FirstModel settings;
        settings.with_lights = true;
        return initial_tree(Box3(Vec3(0.0f), Vec3(1.0f)), settings);
    }
    static CellSums sums_of(const SdTree& tree, const std::vector<Record>& records, std::uint32_t vertices) {
        const SdTreeSampler guide(tree);
        CellAccumulator accumulator(tree.pass, guide, DirectionalFilter::box, true);
        const std::vector<std::uint32_t> counts(tree.distribution_count(), vertices);
        accumulator.commit(records, counts, {});
        return accumulator.take();
    }
    static std::vector<Record> some_records(const SdTree& tree) {
        std::vector<Record> records;
        for (std::uint32_t i = 0; i < 3000; ++i) {
            const std::uint32_t region = i % tree.region_count();
            records.push_back({region, i * 1234567u, i * 7654321u, 1.0f, 0.5f, static_cast<std::uint8_t>(i % 16)});
            const auto cluster = static_cast<std::uint8_t>(i % 5 * 3);
            records.push_back(light_record(region, tree.quantum_exponent[region], cluster, 0.2f, float(cluster)));
        }
        return records;
    }
    /// Two regions, learned from some_records.
    static SdTree learned() {
        const SdTree tree = root();
        RefineSettings settings;
        settings.spatial_threshold = 2000;
        RefineReport report;
        return TreeLearner().learn(tree, sums_of(tree, some_records(tree), 3000), settings, true, report);
    }
};

TEST_F(LightLearning, PartsInheritAndLearnOn) {
    const SdTree next = learned();
    ASSERT_EQ(next.region_count(), 2u);
    ASSERT_EQ(next.light_probabilities.size(), 2u);
    EXPECT_EQ(next.light_probabilities[0], next.light_probabilities[1]);
    EXPECT_NEAR(part(next.light_probabilities[0], 12) / part(next.light_probabilities[0], 3), 4.0, 0.01);
    EXPECT_EQ(part(next.light_probabilities[0], 0), 0.0) << "it brought nothing";
}

TEST_F(LightLearning, SumsOfPartsAreTheSumOfTheWhole) {
    const SdTree tree = learned();
    const std::vector<Record> records = some_records(tree);
    CellSums merged(tree.pass, sums_of(tree, {}, 0).shape());
    for (std::size_t at = 0; at < records.size(); at += 1500) {
        const std::vector<Record> some(records.begin() + static_cast<std::ptrdiff_t>(at),
                                       records.begin() + static_cast<std::ptrdiff_t>(at) + 1500);
        merged.merge_encoded(sums_of(tree, some, 0).encode());
    }
    EXPECT_EQ(merged, sums_of(tree, records, 0));
    CellSums added(tree.pass, merged.shape());
    added.add(merged);
    EXPECT_EQ(added, merged);
    CellSums without(tree.pass, {tree.region_count(), tree.cell_count(), true});
    EXPECT_THROW(without.merge_encoded(merged.encode()), FormatError);
}

TEST_F(LightLearning, SumsOfAnotherTreeAreRefused) {
    SdTree next = root();
    EXPECT_THROW(LightLearner().learn(root(), CellSums(0, 1, next.cell_count(), true), {}, next), RunError);
}

TEST_F(LightLearning, TheCodecKeepsProbabilitiesAndRefusesBrokenOnes) {
    const SdTree tree = learned();
    EXPECT_EQ(decode_tree(encode_tree(tree)).light_probabilities, tree.light_probabilities);
    EXPECT_TRUE(decode_tree(encode_tree(initial_tree(Box3(Vec3(0.0f), Vec3(1.0f)), 1.0f))).light_probabilities.empty());
    SdTree broken = tree;
    ++broken.light_probabilities[1][4];
    EXPECT_THROW(decode_tree(encode_tree(broken)), FormatError);
    broken = tree;
    broken.light_probabilities.pop_back();
    EXPECT_THROW(decode_tree(encode_tree(broken)), FormatError);
}

}  // namespace
}  // namespace treefarm
