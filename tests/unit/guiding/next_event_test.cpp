// SPDX-License-Identifier: Apache-2.0
// How often next event is asked: what is counted, what is decided by it, and what is sent.
#include "common/guiding/regions/next_event.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "common/base/error.h"
#include "common/base/random.h"
#include "common/decide/next_event/next_event_constants.h"
#include "common/guiding/sd_tree/sd_tree_sampler.h"
#include "common/guiding/sd_tree/tree_learner.h"
#include "common/guiding/statistics/cell_accumulator.h"

namespace treefarm {
namespace {

constexpr std::size_t kChoices = kNextEventSamples.size();
/// Cost of a light sample whose ray is traced, in rays.
constexpr double kLightSample =
    tuned<policy::kNextEvent>("next_event.sample_cost") + tuned<policy::kNextEvent>("next_event.shadow_ray_cost");

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

std::uint8_t decided(const NextEventEvidence& e, std::uint8_t code = 0, TreesLearn trees = TreesLearn::nothing) {
    decide_next_event({&e, 1}, 1000, {1.0, 8.0, 1000}, trees, {&code, 1});
    return code;
}

TEST(NextEvent, IsHardlyAskedWhereItFindsNothing) {
    EXPECT_EQ(decided(evidence(2000, 100, 100)), kChoices - 1) << "at once";
    EXPECT_EQ(decided(evidence(2000, 100, 1600)), 0) << "an open lamp";
    EXPECT_EQ(decided(evidence(2000, 100, 1600), kChoices - 1), 0) << "and back, at once";
    EXPECT_EQ(decided(evidence(100, 1, 1)), 0) << "nobody knows";
    NextEventEvidence unsure = evidence(2000, 100, 150);
    EXPECT_EQ(decided(unsure), kChoices - 1);
    unsure[kNextEventSpread] = 1000.0 * 1000.0;
    EXPECT_EQ(decided(unsure), 0) << "two standard errors";
}

/// Evidence by which noise and cost at n = 1/16 are `by` above those at n = 1, and half of it at n = 1/4.
NextEventEvidence dearer(double by) {
    const double rays = 1.0 / 8.0 * kLightSample * 2000, always = 100 + rays;
    NextEventEvidence e = evidence(2000, 100, 100 + rays * 15 / 16 + by * always);
    e[kNextEventMoments + 1] = 100 + rays * 3 / 4 + by / 2 * always;
    return e;
}

/// What is a tie by the trees of today goes to fewer light samples, whose light those of tomorrow learn.
TEST(NextEvent, TreesAreExpectedToLearnWhatLightSamplesFound) {
    EXPECT_EQ(decided(dearer(0.03)), 0);
    EXPECT_EQ(decided(dearer(0.03), 0, TreesLearn::on), kChoices - 1);
    EXPECT_EQ(decided(dearer(0.30), 0, TreesLearn::on), 0);
    EXPECT_EQ(decided(dearer(0.03), kChoices - 1, TreesLearn::on), kChoices - 1) << "and no way back";
    EXPECT_EQ(decided(dearer(0.60), kChoices - 1, TreesLearn::on), 0) << "but where it is surely worse";
    EXPECT_EQ(decided(dearer(0.03), 0, TreesLearn::no_more), 0) << "no tree will learn it";
    EXPECT_EQ(decided(dearer(0.03), kChoices - 1, TreesLearn::no_more), kChoices - 1) << "the last one has";
    NextEventEvidence unsure = dearer(0.03);
    unsure[kNextEventSpread] = 200.0 * 200.0;
    EXPECT_EQ(decided(unsure, 0, TreesLearn::on), 0) << "two standard errors, of which nothing is credited";
}

/// Variance times cost of an image of these regions, by the closed form: the rest of both is no region's.
double work(std::span<const NextEventEvidence> regions, std::span<const std::uint8_t> codes, double paths,
            const NextEventPrice& always) {
    double variance = always.variance, cost = always.rays;
    for (std::size_t r = 0; r < regions.size(); ++r) {
        const NextEventEvidence& e = regions[r];
        variance += (e[kNextEventMoments + codes[r]] - e[kNextEventMoments]) / paths;
        cost -= kLightSample * e[kNextEventAsked] / paths * (1.0 - double(kNextEventSamples[codes[r]]));
    }
    return variance * cost;
}

/// Passes of the same evidence end where nearly the least work is, that of all 3^4 ways to decide.
TEST(NextEvent, DecisionsEndAtTheLeastWork) {
    double worst = 1, logs = 0;
    constexpr std::uint32_t kImages = 400;
    for (std::uint32_t i = 0; i < kImages; ++i) {
        std::array<NextEventEvidence, 4> regions;
        double moments = 0;
        for (std::uint32_t r = 0; r < 4; ++r) {
            const Draw random = draw({3, i, r}, 0, Stream::light);
            const double often = std::exp(8.0 * double(to_unit(random[0])) - 4.0);
            regions[r] = evidence(1000 + 4000 * double(to_unit(random[1])), often,
                                  often * std::pow(16.0, double(to_unit(random[2]))));
            moments += often;
        }
        const NextEventPrice always{moments / 1000 + 0.1, kLightSample * 33.0, 1000};
        double least = std::numeric_limits<double>::infinity();
        for (std::uint32_t way = 0; way < 81; ++way) {
            const std::array<std::uint8_t, 4> codes = {std::uint8_t(way % 3), std::uint8_t(way / 3 % 3),
                                                       std::uint8_t(way / 9 % 3), std::uint8_t(way / 27)};
            least = std::min(least, work(regions, codes, 1000, always));
        }
        std::array<std::uint8_t, 4> codes{};
        for (int pass = 0; pass < 4; ++pass) {
            NextEventPrice price = always;
            price.rays = 0;
            for (std::size_t r = 0; r < 4; ++r)
                price.variance += (regions[r][kNextEventMoments + codes[r]] - regions[r][kNextEventMoments]) / 1000;
            price.rays = work(regions, codes, 1000, always) / price.variance;
            decide_next_event(regions, 1000, price, TreesLearn::nothing, codes);
        }
        const double ratio = work(regions, codes, 1000, always) / least;
        worst = std::max(worst, ratio);
        logs += std::log(ratio) / kImages;
    }
    EXPECT_LT(std::exp(logs), 1.01);
    EXPECT_LT(worst, 1.1);
}

/// A cube in two halves.
RegionModel halves() {
    RegionModel model;
    model.nodes.resize(3);
    model.nodes[0].child[0] = 1;
    model.nodes[0].child[1] = 2;
    model.nodes[1].child[1] = 0;
    model.nodes[2].child[1] = 1;
    return model;
}

TEST(NextEvent, RegionsThatKnowLittleLeanOnTheCubeAboutThem) {
    constexpr double kLent = tuned<policy::kNextEvent>("next_event.lent_vertices");
    const std::array<NextEventEvidence, 2> evidences = {evidence(1e6, 5e5, 6e5), evidence(100, 0, 0)};
    const std::vector<NextEventEvidence> pooled = pool_next_event(halves(), evidences);
    const double all = 1e6 + 100;
    for (std::size_t i = 0; i < kNextEventSpread; ++i) {
        const double about = (evidences[0][i] + evidences[1][i]) / all;
        EXPECT_NEAR(pooled[0][i], evidences[0][i], 1e-3 * evidences[0][i]) << i;
        const double lent = 100 / (100 + kLent) * (evidences[1][i] + kLent * about);
        EXPECT_NEAR(pooled[1][i], lent, 1e-3 * lent) << i;
    }
}

/// Errors by theory: of independent vertices that spread alike, and of what a child leans on.
TEST(NextEvent, WhatIsLentIsAsSureAsItWasKnown) {
    constexpr double kLent = tuned<policy::kNextEvent>("next_event.lent_vertices");
    std::array<NextEventEvidence, 2> evidences = {evidence(1000, 1, 2), evidence(1000, 1, 2)};
    for (NextEventEvidence& e : evidences)
        e[kNextEventSpread] = 1000 * 4.0;  // a mean square of 4
    const std::vector<NextEventEvidence> pooled = pool_next_event(halves(), evidences);
    const double whole = 4.0 / 2000, root = (2000 * 4.0 + kLent * kLent * whole) / ((2000 + kLent) * (2000 + kLent)),
                 half = (1000 * 4.0 + kLent * kLent * root) / ((1000 + kLent) * (1000 + kLent));
    EXPECT_NEAR(pooled[0][kNextEventSpread], 1000.0 * 1000.0 * half, 1e-6 * 1000 * 4);
    EXPECT_LT(pooled[0][kNextEventSpread], 4000.0) << "what is lent makes it surer";
    RegionModel whole_model;
    whole_model.nodes.resize(1);
    const std::array<NextEventEvidence, 1> nothing{};
    EXPECT_EQ(pool_next_event(whole_model, nothing)[0], nothing[0]) << "nothing is known";
}

/// By construction of the rule: a step never makes the product of noise and cost larger, as predicted; with credit not
/// by much.
TEST(NextEvent, WhatIsDecidedNeverCostsMore) {
    for (std::uint32_t i = 0; i < 4000; ++i) {
        const TreesLearn trees = i % 2 == 0 ? TreesLearn::nothing : TreesLearn::on;
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
        const NextEventVerdict verdict =
            decide_next_event(regions, 1000, {moments / 1000 + 0.1, 30.0, 1000}, trees, codes);
        EXPECT_LE(verdict.saved, trees == TreesLearn::on ? 1.25 : 1.0 + 1e-9);
        EXPECT_GT(verdict.saved, 0.0);
    }
}

SdTree root() {
    SdTree tree = initial_tree(Box3(Vec3(0.0f), Vec3(1.0f)), 1.0f);
    tree.next_event = {0};
    return tree;
}

/// Noise and cost at n = 1/16 are 3 % above those at n = 1: only what a tree will learn speaks for it.
TEST(NextEvent, CreditIsForTreesThatWillLearn) {
    const NextEventEvidence found = dearer(0.03);
    NextEventSums sums{};
    for (std::size_t i = 0; i < kNextEventSums; ++i)
        sums[i] = static_cast<std::uint64_t>(found[i] / next_event_unit(i));
    SumsShape shape(1, 1);
    shape.with_next_event = true;
    CellSums counted(0, shape);
    counted.add_next_event(0, sums);
    RefineSettings settings;
    settings.next_event = {1.0, 8.0, 1000};
    for (const bool last : {false, true}) {
        settings.last_update = last;
        RefineReport report;
        report.origins = {{0, 0}};
        SdTree next = root();
        NextEventLearner().learn(root(), counted, settings, report, next);
        EXPECT_EQ(int{next.next_event[0]}, last ? 0 : 2);
    }
    std::uint8_t code = 0;
    ImageNextEventLearner().learn(sums, settings.next_event, code);
    EXPECT_EQ(int{code}, 0) << "nothing guides";
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

/// Light that scattering meets counts for a region even where a unit has asked no emitter: else what is summed would
/// depend on how the farm cuts units.
TEST(NextEvent, MomentsAloneAreCommitted) {
    const SdTree tree = root();
    const SdTreeSampler guide(tree);
    CellAccumulator accumulator(0, guide);
    const std::array<std::uint32_t, 1> counts{1};
    NextEventSums met{};
    met[kNextEventMoments] = 5;
    accumulator.commit({}, counts, {}, {&met, 1});
    EXPECT_EQ(accumulator.take().next_event(0)[kNextEventMoments], 5u);
}

/// Means are of samples that were tossed for: a little more than 1/4 is 1/4.
TEST(NextEvent, TheCodeOfAMeanIsTheNearestByRatio) {
    for (const auto& [mean, code] :
         {std::pair(1.0, 0), {0.51, 0}, {0.49, 1}, {0.2501, 1}, {0.126, 1}, {0.124, 2}, {0.0625, 2}, {0.0, 2}})
        EXPECT_EQ(int{next_event_code(mean)}, code) << mean;
}

TEST(NextEvent, CountsMultiples) {
    EXPECT_EQ(multiples_in(0, 1, 8), 1u);
    EXPECT_EQ(multiples_in(1, 7, 8), 0u);
    EXPECT_EQ(multiples_in(1, 8, 8), 1u);
    EXPECT_EQ(multiples_in(7, 100, 8), 13u);
}

}  // namespace
}  // namespace treefarm
