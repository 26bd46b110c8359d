// SPDX-License-Identifier: Apache-2.0
// How often next event is asked: what is counted, what is decided by it, and what is sent.
#include "common/guiding/regions/next_event.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/base/error.h"
#include "common/base/random.h"
#include "common/film/guiding_worth.h"
#include "common/guiding/sd_tree/sd_tree_sampler.h"
#include "common/guiding/sd_tree/tree_learner.h"
#include "worker/integrators/path/unguided_twin.h"

namespace treefarm {
namespace {

constexpr std::size_t kChoices = kNextEventSamples.size();

/// Direct light over [0, 1): scattering is uniform, emitters are drawn with density 2 x, and x^2 arrives.
double density(double x, double n) {
    return 1.0 + n * 2.0 * x;
}

/// Whatever number of light samples was in force, the sums say what each would be like: held against the integral.
TEST(NextEventSums, ExpectationsDoNotDependOnTheNumberInForce) {
    for (const float n : {1.0f, 0.25f, 0.0625f}) {
        NextEventSums sums{};
        constexpr std::uint32_t kVertices = 200000;
        const auto add = [&](double x, std::uint32_t bits) {
            const double light = x * x;
            add_direct_light(sums, static_cast<float>(light / density(x, double(n))), 1.0f, static_cast<float>(2 * x),
                             n, bits);
        };
        for (std::uint32_t i = 0; i < kVertices; ++i) {
            const Draw random = draw({1, i, 0}, 0, Stream::light);
            add(double(to_unit(random[0])), random[3]);
            if (to_unit(random[1]) < n) add(std::sqrt(double(to_unit(random[2]))), scrambled(random[3], 1));
        }
        for (std::size_t choice = 0; choice < kChoices; ++choice) {
            double truth = 0;
            for (int i = 0; i < 10000; ++i) {
                const double x = (i + 0.5) * 1e-4;
                truth += 1e-4 * x * x * x * x / density(x, double(kNextEventSamples[choice]));
            }
            const std::size_t sum = kNextEventMoments + choice;
            const double found = static_cast<double>(sums[sum]) * next_event_unit(sum) / kVertices;
            EXPECT_NEAR(found / truth, 1.0, 0.02) << "n " << n << " for " << kNextEventSamples[choice];
        }
    }
}

NextEventEvidence evidence(double vertices, double often, double rarely) {
    NextEventEvidence e{};
    e[kNextEventAsked] = e[kNextEventDrawn] = e[kNextEventTraced] = vertices;
    e[kNextEventMoments] = often;
    e[kNextEventMoments + 1] = 0.5 * (often + rarely);
    e[kNextEventMoments + 2] = rarely;
    return e;
}

std::uint8_t decided(const NextEventEvidence& e, std::uint8_t code = 0) {
    decide_next_event({&e, 1}, 1000, {1.0, 8.0, 1000}, {&code, 1});
    return code;
}

TEST(NextEvent, IsHardlyAskedWhereItFindsNothing) {
    EXPECT_EQ(decided(evidence(2000, 100, 100)), kChoices - 1);
    EXPECT_EQ(decided(evidence(2000, 100, 1600)), 0) << "an open lamp";
    EXPECT_EQ(decided(evidence(2000, 100, 1600), kChoices - 1), 0) << "and back";
    EXPECT_EQ(decided(evidence(100, 1, 1)), 0) << "nobody knows";
    NextEventEvidence unsure = evidence(2000, 100, 150);
    EXPECT_EQ(decided(unsure), kChoices - 1);
    unsure[kNextEventSpread] = 1000.0 * 1000.0;
    EXPECT_EQ(decided(unsure), 0) << "two standard errors";
}

/// By construction of the rule: a step never makes the product of noise and cost larger, as predicted.
TEST(NextEvent, WhatIsDecidedNeverCostsMore) {
    for (std::uint32_t i = 0; i < 2000; ++i) {
        std::array<NextEventEvidence, 4> regions;
        std::array<std::uint8_t, 4> codes{};
        double moments = 0;
        for (std::uint32_t r = 0; r < 4; ++r) {
            const Draw random = draw({2, i, r}, 0, Stream::light);
            const double often = std::exp(8.0 * double(to_unit(random[0])) - 4.0);
            regions[r] = evidence(1000 + 4000 * double(to_unit(random[1])), often,
                                  often * (1 + 15 * double(to_unit(random[2]))));
            moments += often;
        }
        const NextEventVerdict verdict = decide_next_event(regions, 1000, {moments / 1000 + 0.1, 30.0, 1000}, codes);
        EXPECT_LE(verdict.saved, 1.0 + 1e-9);
        EXPECT_GT(verdict.saved, 0.0);
    }
}

SdTree root() {
    SdTree tree = initial_tree(Box3(Vec3(0.0f), Vec3(1.0f)), 1.0f);
    tree.next_event = {0};
    return tree;
}

TEST(NextEvent, TheCodecKeepsDecisionsAndRefusesBrokenOnes) {
    SdTree tree = root();
    tree.next_event = {2};
    tree.image = {2, {0.5f, 1.0f, 2.0f, 4.0f}, 1};
    const SdTree decoded = decode_tree(encode_tree(tree));
    EXPECT_EQ(decoded.next_event, tree.next_event);
    EXPECT_EQ(decoded.image, tree.image);
    SdTree broken = tree;
    broken.next_event = {3};
    EXPECT_THROW(decode_tree(encode_tree(broken)), FormatError);
    broken = tree;
    broken.image.inverse_levels[1] = -1.0f;
    EXPECT_THROW(decode_tree(encode_tree(broken)), FormatError);
    const SdTreeSampler guide(tree);
    EXPECT_EQ(guide.next_event(0), 0.0625f);
    EXPECT_EQ(guide.image_next_event(), 0.25f);
    EXPECT_EQ(guide.inverse_level(7, 7), 0.5f);
    EXPECT_EQ(guide.inverse_level(8, 9), 4.0f);
    EXPECT_EQ(guide.inverse_level(8, 99), 0.0f) << "beyond the image";
}

TEST(NextEvent, SumsMergeInAnyOrder) {
    SumsShape shape(2, 4);
    shape.with_next_event = true;
    CellSums a(0, shape), b(0, shape), one(0, shape), other(0, shape);
    a.add_next_event(1, {5, 4, 3, 2, 1, 7, ~std::uint64_t{0}});
    b.add_next_event(1, {1, 1, 1, 1, 1, 1, 1});
    b.add_next_event(0, {9, 0, 0, 0, 0, 0, 0});
    one.merge_encoded(a.encode());
    one.merge_encoded(b.encode());
    other.merge_encoded(b.encode());
    other.merge_encoded(a.encode());
    EXPECT_EQ(one, other);
    EXPECT_EQ(one.next_event(1)[kNextEventSpread], ~std::uint64_t{0});
    EXPECT_EQ(one.next_event(0)[kNextEventAsked], 9u);
}

/// Paths of up to three steps: each goes left with the chance `a` (guided) or `b` (unguided), finds 1 on the left and 3
/// on the right, and ends. What guided paths tell is held against the unguided sum over all ways.
TEST(UnguidedTwin, TellsTheSecondMomentAndCostOfUnguidedPaths) {
    constexpr double kGuided = 0.7, kUnguided = 0.2, kLeft = 0.9, kRight = 0.4;
    double truth = 0, true_cost = 0, told = 0, cost = 0;
    constexpr int kSteps = 3;
    for (int way = 0; way < (1 << kSteps); ++way) {
        double guided = 1, unguided = 1, found = 0, carried = 1;
        float throughput = 1.0f;
        UnguidedTwin twin;
        for (int step = 0; step < kSteps; ++step) {
            const bool left = way >> step & 1;
            const double p = left ? kGuided : 1 - kGuided, q = left ? kUnguided : 1 - kUnguided;
            twin.add_cost(1.0f);
            guided *= p;
            unguided *= q;
            carried *= (left ? kLeft : kRight) / q;
            throughput *= static_cast<float>((left ? kLeft : kRight) / p);
            twin.step(static_cast<float>(p), static_cast<float>(q));
            found += carried * (left ? 1.0 : 3.0);
            twin.add(throughput * (left ? 1.0f : 3.0f));
        }
        truth += unguided * found * found;
        true_cost += unguided * kSteps;
        told += guided * double(twin.moment());
        cost += guided * double(twin.cost());
    }
    EXPECT_NEAR(told / truth, 1.0, 1e-5);
    EXPECT_NEAR(cost / true_cost, 1.0, 1e-5);
}

TEST(UnguidedTwin, WhatUnguidedPathsNeverDoTellsNothing) {
    UnguidedTwin twin;
    twin.step(0.5f, 0.0f);
    twin.add(3.0f);
    twin.add_cost(1.0f);
    EXPECT_EQ(twin.moment(), 0.0f);
    EXPECT_EQ(twin.cost(), 0.0f);
}

}  // namespace
}  // namespace treefarm
