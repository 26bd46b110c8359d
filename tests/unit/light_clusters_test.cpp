// SPDX-License-Identifier: Apache-2.0
// Clusters of emitters, and what learned choices do to densities.
#include "worker/lights/light_clusters.h"

#include <gtest/gtest.h>

#include "tests/support/chi_square.h"
#include "tests/support/test_scenes.h"
#include "worker/lights/emitters.h"

namespace treefarm {
namespace {

LightProbabilities some_probabilities() {
    LightProbabilities probabilities{};
    probabilities[0] = kLightProbabilityOne / 4;
    probabilities[1] = kLightProbabilityOne / 2;
    probabilities[3] = kLightProbabilityOne / 8;
    probabilities[4] = kLightProbabilityOne / 8;
    return probabilities;
}

std::uint32_t bits(std::uint32_t i) {
    return draw({5, i, 0}, 1, Stream::light)[0];
}

TEST(LightClusters, FewEntriesHaveOneEach) {
    const LightClusters clusters(DiscreteTable(std::vector<double>{1.0, 0.0, 3.0, 4.0}));
    EXPECT_EQ(clusters.count(), 3);
    EXPECT_EQ(clusters.of_entry(0), 0);
    EXPECT_EQ(clusters.of_entry(2), 1);
    EXPECT_EQ(clusters.of_entry(3), 2);
}

TEST(LightClusters, ManyEntriesShareThem) {
    for (const std::size_t entries : {15u, 16u, 17u, 100u, 5000u}) {
        std::vector<double> weights(entries);
        for (std::size_t i = 0; i < entries; ++i)
            weights[i] = i % 7 == 3 ? 50.0 : 1.0 + double(i % 3);
        const LightClusters clusters{DiscreteTable(weights)};
        EXPECT_EQ(clusters.count(), kLightClusters) << entries;
        for (std::uint32_t i = 1; i < entries; ++i) {
            const int step = clusters.of_entry(i) - clusters.of_entry(i - 1);
            ASSERT_TRUE(step == 0 || step == 1) << entries;
        }
        EXPECT_EQ(clusters.of_entry(0), 0);
        EXPECT_EQ(clusters.of_entry(static_cast<std::uint32_t>(entries) - 1), kLightClusters - 1);
    }
}

TEST(LightClusters, WithoutWeightThereIsNone) {
    const LightClusters clusters{DiscreteTable(std::vector<double>{0.0, 0.0})};
    EXPECT_EQ(clusters.count(), 0);
    const LightProbabilities probabilities = some_probabilities();
    EXPECT_EQ(clusters.factor(&probabilities, 1), 1.0f);
}

TEST(LightClusters, UntaughtTheChoiceIsThatByPower) {
    const DiscreteTable table(std::vector<double>{1.0, 2.0, 0.5, 3.0});
    const LightClusters clusters(table);
    const LightProbabilities untaught = {kLightProbabilityOne};
    for (std::uint32_t i = 0; i < 10000; ++i) {
        const LightClusters::Choice choice = clusters.pick(untaught, bits(i));
        ASSERT_EQ(choice.bits, bits(i));
        ASSERT_EQ(choice.factor, 1.0f);
    }
    EXPECT_EQ(clusters.factor(&untaught, 2), 1.0f);
    EXPECT_EQ(clusters.factor(nullptr, 2), 1.0f);
}

TEST(LightClusters, EntriesAreChosenAsOftenAsTheirFactorsSay) {
    std::vector<double> weights(40);
    for (std::size_t i = 0; i < weights.size(); ++i)
        weights[i] = 1.0 + double(i * 5 % 7);
    for (const std::size_t entries : {4u, 40u}) {
        const DiscreteTable table(std::span<const double>(weights).first(entries));
        const LightClusters clusters(table);
        const LightProbabilities probabilities = some_probabilities();
        constexpr std::uint32_t kSamples = 200000;
        std::vector<double> counts(entries), expected(entries);
        for (std::uint32_t i = 0; i < kSamples; ++i) {
            const LightClusters::Choice choice = clusters.pick(probabilities, bits(i));
            const std::uint32_t entry = table.pick(choice.bits);
            ASSERT_EQ(clusters.of_entry(entry), choice.cluster);
            ASSERT_EQ(clusters.factor(&probabilities, entry), choice.factor);
            ++counts[entry];
        }
        double whole = 0;
        for (std::uint32_t e = 0; e < entries; ++e)
            whole += expected[e] = kSamples * double(table.probability(e)) * double(clusters.factor(&probabilities, e));
        EXPECT_NEAR(whole, kSamples, 1e-3 * kSamples);
        EXPECT_GT(test::chi_square_test(counts, expected), 1e-4);
    }
}

/// Integrals of radiance over directions agree however emitters are chosen, and densities are those of the samples.
TEST(LightClusters, EmittersByProbability) {
    Scene scene;
    test::add_shape(scene, test::quad({-1, -1, 3}, {0, 2, 0}, {2, 0, 0}), kNone, Rgb(1.0f));
    test::add_shape(scene, Sphere{Vec3(3, 0, 0), 0.7f, false}, kNone, Rgb(2.0f));
    scene.emitters.push_back({ConstantEmitter{Rgb(0.2f)}, {}});
    scene.emitters.push_back({PointEmitter{Vec3(0, 0, 2), Rgb(1.0f)}, {}});
    const EmbreeScene geometry(scene.shapes, "avx2");
    const Emitters emitters(scene.emitters, geometry, scene.bounds());
    ASSERT_EQ(emitters.clusters().count(), 4);
    const Vec3 p(0.1f, 0.2f, -0.3f);
    const LightProbabilities probabilities = some_probabilities();
    const auto brought = [&](const LightProbabilities* s) {
        double sum = 0;
        constexpr std::uint32_t kSamples = 400000;
        for (std::uint32_t i = 0; i < kSamples; ++i) {
            const DirectSample light = emitters.sample_direct(p, draw({5, i, s != nullptr}, 1, Stream::light), s);
            if (!light.delta) {
                const float pdf = light.at_infinity() ? emitters.pdf_environment(light.wi, s)
                                                      : emitters.pdf_direct(p, light.wi, light.on_light, s);
                EXPECT_NEAR(light.pdf / pdf, 1.0f, 1e-4f);
            }
            const Rgb radiance = light.from_environment ? emitters.environment(light.wi) : light.radiance;
            sum += double(radiance.x) / double(light.pdf) / kSamples;
        }
        return sum;
    };
    const double by_power = brought(nullptr);
    EXPECT_NEAR(brought(&probabilities), by_power, 0.01 * by_power);
}

}  // namespace
}  // namespace treefarm
