// SPDX-License-Identifier: Apache-2.0
// A mixture of any number of techniques: what is drawn, its density, and fractions learned from exact sums.
#include "worker/guides/technique_list.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "common/guiding/statistics/cell_sums.h"
#include "common/math/direction_map.h"

namespace treefarm {
namespace {

/// A guide without data, whose own distribution samples the second quarter of the sphere.
struct QuarterSampler {
    std::array<float, 2> fraction;
    float least = 0.0f;
};
constexpr float kQuarter = 4 * kInvFourPi;

/// Technique that samples quarter `n` of the sphere.
template <std::uint32_t n>
struct QuarterTechnique {
    using Local = LocalDistribution<QuarterTechnique>;
    static constexpr bool kOnSquare = true;
    static void find(const QuarterSampler&, bool exists, const Vec3&, const Vec3&, std::uint32_t, std::uint32_t&,
                     Local& here) {
        here.distribution = exists ? n - 1 : kNoDistribution;
    }
    static float fraction(const QuarterSampler& guide, const Local&) { return guide.fraction[n - 2]; }
    static float least_bsdf_fraction(const QuarterSampler& guide, const Local&) { return n == 2 ? guide.least : 0.0f; }
};
using ThreeQuarters = TechniqueList<QuarterSampler, QuarterTechnique<2>>;
using FourQuarters = ThreeQuarters::With<QuarterSampler, QuarterTechnique<3>>;

template <class List>
typename List::Guidance quarters_at(const QuarterSampler& guide, float bsdf_fraction, bool exist = true) {
    typename List::Guidance guidance{};
    guidance.bsdf_fraction = bsdf_fraction;
    std::uint32_t code = 0;
    List::template find<true>(guide, exist, Vec3(0.0f), Vec3(0.0f), code, guidance);
    return guidance;
}

/// Fractions of BSDF, region, and further techniques: how often each is chosen.
template <class List>
std::vector<double> chosen(const typename List::Guidance& guidance) {
    std::vector<double> share(2 + List::kFurther);
    constexpr int kSteps = 1 << 16;
    for (int i = 0; i < kSteps; ++i) {
        const float technique = (static_cast<float>(i) + 0.5f) / kSteps;
        const bool guided = !(technique < guidance.bsdf_fraction);
        share[guided ? 1u + List::choose(guidance, technique) : 0u] += 1.0 / kSteps;
    }
    return share;
}

TEST(TechniqueList, EachIsChosenByTheFractionThatItsDensityHas) {
    const QuarterSampler guide{{0.25f, 0.5f}};
    const FourQuarters::Guidance guidance = quarters_at<FourQuarters>(guide, 0.4f);
    const std::vector<double> share = chosen<FourQuarters>(guidance);
    const double expected[] = {0.4 * 0.75 * 0.5, 0.6 * 0.75 * 0.5, 0.25 * 0.5, 0.5};
    for (std::size_t t = 0; t < 4; ++t) {
        std::array<float, 4> pdf{};
        pdf[t] = 1.0f;
        EXPECT_NEAR(share[t], expected[t], 1e-4) << t;
        EXPECT_NEAR(FourQuarters::mixed_pdf(guidance, pdf[0], pdf[1], {pdf[2], pdf[3]}), expected[t], 1e-6) << t;
    }
}

TEST(TechniqueList, ATechniqueThatAVertexLacksChangesNoBit) {
    const QuarterSampler guide{{0.25f, 0.5f}};
    const auto without = quarters_at<FourQuarters>(guide, 0.37f, false);
    EXPECT_EQ(without.bsdf_fraction, 0.37f);
    EXPECT_EQ(FourQuarters::mixed_pdf(without, 2.3f, 0.7f, {}), mixed_pdf(0.37f, 2.3f, 0.7f));
    EXPECT_EQ((TechniqueList<QuarterSampler>::mixed_pdf({{0, 0.37f}}, 2.3f, 0.7f, {})), mixed_pdf(0.37f, 2.3f, 0.7f));
    for (int i = 37; i < 100; ++i)  // below, the BSDF is chosen
        EXPECT_EQ(FourQuarters::choose(without, static_cast<float>(i) / 100), 0);
    ThreeQuarters::Scatter s{};
    s.bsdf_pdf = 2.3f;
    s.guide_pdf = 0.7f;
    EXPECT_EQ(ThreeQuarters::bins(quarters_at<ThreeQuarters>(guide, 0.37f, false), s)[0], mixture_bin(2.3f, 0.7f));
}

TEST(TechniqueList, TheBsdfKeepsWhatATechniqueLeavesItAtLeast) {
    const auto guidance = quarters_at<FourQuarters>({{0.95f, 0.5f}, 0.2f}, 0.4f);
    const auto& first = FourQuarters::local<QuarterTechnique<2>>(guidance);
    const auto& second = FourQuarters::local<QuarterTechnique<3>>(guidance);
    EXPECT_FLOAT_EQ(guidance.bsdf_fraction, 0.2f * 0.5f);
    EXPECT_FLOAT_EQ(first.fraction, 0.8f * 0.5f);
    EXPECT_FLOAT_EQ(second.fraction, 0.5f);
}

TEST(TechniqueList, ATechniqueIsWeighedAgainstTheMixtureBeforeIt) {
    const auto guidance = quarters_at<FourQuarters>({{0.25f, 0.5f}}, 0.4f);
    const auto fewer = quarters_at<ThreeQuarters>({{0.25f, 0.5f}}, 0.4f);
    EXPECT_FLOAT_EQ(FourQuarters::pdf_before<0>(guidance, 2, 3, {5, 7}), mixed_pdf(0.4f, 2, 3));
    EXPECT_FLOAT_EQ(FourQuarters::pdf_before<1>(guidance, 2, 3, {5, 7}), ThreeQuarters::mixed_pdf(fewer, 2, 3, {5}));
}

/// Light whose quarters send these shares, recorded by weights of what is drawn, as paths do: the BSDF samples all of
/// the sphere evenly, each technique of the guide one quarter. Sums of a pass that are cut into parts and merged in any
/// order are the same. Fractions are those that fit best one by one (found by hand: the derivative is 0), up to the
/// width of the bins.
TEST(TechniqueList, FractionsAreLearnedFromExactSums) {
    const std::array<double, 4> light = {0.04, 0.5, 0.26, 0.2};
    std::mt19937 engine(3);
    const auto random = [&] { return static_cast<std::uint32_t>(engine()); };
    std::array<MixtureHistogram, 3> histograms{};
    std::array<double, 3> before = {0.5, 0.5, 0.5};  // of the techniques before the region's, the first, the second
    for (int pass = 0; pass < 8; ++pass) {
        const QuarterSampler guide{{static_cast<float>(1 - before[1]), static_cast<float>(1 - before[2])}};
        const auto guidance = quarters_at<FourQuarters>(guide, static_cast<float>(before[0]));
        struct Binned {
            FourQuarters::Bins bins;
            std::uint64_t quanta;
        };
        std::vector<Binned> records;
        for (int i = 0; i < 20'000; ++i) {
            const float technique = to_unit(random());
            const bool guided = !(technique < guidance.bsdf_fraction);
            const std::size_t quarter = guided ? 1u + FourQuarters::choose(guidance, technique) : random() % 4;
            FourQuarters::Scatter s{};
            s.bsdf_pdf = kInvFourPi;
            s.guide_pdf = quarter == 1 ? kQuarter : 0.0f;
            s.further_pdf = {quarter == 2 ? kQuarter : 0.0f, quarter == 3 ? kQuarter : 0.0f};
            s.pdf = FourQuarters::mixed_pdf(guidance, s.bsdf_pdf, s.guide_pdf, s.further_pdf);
            const double reflected = light[quarter] * double(kQuarter / s.pdf);
            records.push_back({FourQuarters::bins(guidance, s), static_cast<std::uint64_t>(reflected * 65536)});
        }
        const SumsShape shape(1, 0, true, 2);
        const auto add = [](CellSums& sums, const Binned& record) {
            for (std::uint32_t d = 0; d < 3; ++d) {
                sums.add_count(d, 1);
                sums.add_mixture(d, record.bins[d], record.quanta);
            }
        };
        CellSums whole(0, shape), merged(0, shape);
        for (const Binned& record : records)
            add(whole, record);
        std::shuffle(records.begin(), records.end(), engine);
        for (std::size_t part = 0; part < 5; ++part) {
            CellSums sums(0, shape);
            for (std::size_t i = part; i < records.size(); i += 5)
                add(sums, records[i]);
            merged.merge_encoded(sums.encode());
        }
        ASSERT_TRUE(merged == whole);
        for (std::uint32_t d = 0; d < 3; ++d)
            before[d] = learn_fraction(histograms[d], merged.mixture(d), -16, merged.counts()[d], before[d]);
    }
    EXPECT_NEAR(before[0], 0.667, 0.05);
    EXPECT_NEAR(before[1], 0.888, 0.05);
    EXPECT_NEAR(before[2], 0.939, 0.05);
}

}  // namespace
}  // namespace treefarm
