// SPDX-License-Identifier: Apache-2.0
// guiding.type "auto": what guided paths tell of unguided ones, and what is made of it.
#include "common/decide/guiding/guiding_efficiency.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "common/decide/guiding/guiding_verdict.h"
#include "common/plan/schedule/learning.h"
#include "coordinator/passes/render_state.h"
#include "tests/support/losing_pass.h"
#include "tests/support/resolved.h"
#include "worker/integrators/path/unguided_estimate.h"

namespace treefarm {
namespace {

constexpr std::size_t kEdge = 32, kSquare = kEdge * kEdge;
constexpr std::uint32_t kSamples = 8;

/// Pixels of mean 1, half of whose samples are 1 + deviation and half 1 - deviation.
std::vector<PixelEstimate> pixels(float deviation, std::uint32_t samples = kSamples) {
    std::vector<PixelEstimate> result(kSquare);
    for (PixelEstimate& pixel : result)
        for (std::uint32_t s = 0; s < samples; ++s)
            pixel.add(s, Rgb(s % 2 == 0 ? 1 + deviation : 1 - deviation));
    return result;
}

/// What workers count of such a pass: second moments of its own samples, and of unguided ones that deviate likewise.
UnguidedSums sums_of(double guided, double unguided, double unguided_cost, std::uint32_t samples = kSamples) {
    UnguidedSums sums;
    for (std::uint32_t p = 0; p < kSquare; ++p) {
        UnguidedBlock block;
        for (std::uint32_t s = 0; s < samples; ++s)
            block.add(s % 2 == 0 ? 1 + guided : 1 - guided, 1 + unguided * unguided, unguided_cost);
        block.finish(pixel_group(p % kEdge, p / kEdge), sums);
    }
    return sums;
}

ImageLevels even_levels() {
    return image_levels(std::vector<Rgb64>(kSquare, Rgb64(1.0)), kEdge);
}

/// Worth by pixels that deviate by a half, at 8 rays a sample.
GuidingEfficiency efficiency_of(const UnguidedSums& sums, const ImageLevels& levels = even_levels()) {
    return guiding_evidence(sums, pixels(0.5f), levels, kEdge, 8.0).efficiency();
}

TEST(GuidingEfficiency, IsVarianceTimesCostOfUnguidedOverGuidedSamples) {
    const GuidingEfficiency efficiency = efficiency_of(sums_of(0.5, 1.5, 4.0));
    const double unbiased = kSamples / (kSamples - 1.0);
    EXPECT_NEAR(efficiency.guided_variance, 0.25 * unbiased, 1e-3);
    // The mean's square is that of the guided pixels, of which the noise is taken away.
    EXPECT_NEAR(efficiency.unguided_variance, 1 + 2.25 - (1 + 0.25 - 0.25 * unbiased), 1e-3);
    EXPECT_NEAR(efficiency.unguided_cost, 4.0, 1e-6);
    EXPECT_NEAR(efficiency.efficiency, efficiency.unguided_variance * 4.0 / (efficiency.guided_variance * 8.0), 1e-9);
    EXPECT_NEAR(efficiency.error, 0, 1e-3) << "all groups alike";
    EXPECT_GT(efficiency.known, 60);
}

TEST(GuidingEfficiency, AFewGroupsThatKnowItAllAreNotSure) {
    UnguidedSums sums = sums_of(0.5, 0.5, 4.0);
    sums.unguided[5] += static_cast<std::uint64_t>(1000 * kSamples / UnguidedSums::kMomentUnit);
    const GuidingEfficiency efficiency = efficiency_of(sums);
    EXPECT_GT(efficiency.error, 0.8);
    EXPECT_LT(efficiency.known, 4);
    EXPECT_EQ(efficiency_of({}).efficiency, 0) << "nothing was counted";
    EXPECT_EQ(efficiency_of(sums, {}).efficiency, 0) << "the image was black before";
}

/// Evidence of several passes is that of one with all their samples.
TEST(GuidingEfficiency, EvidenceAddsUpBySamples) {
    const auto of = [](double samples, double guided, double unguided, double cost) {
        GuidingEvidence evidence{.samples = samples, .guided_cost = cost, .unguided_cost = 2 * cost};
        evidence.guided.fill(guided);
        evidence.unguided.fill(unguided);
        return evidence;
    };
    GuidingEvidence all;
    all.add({});
    EXPECT_EQ(all, GuidingEvidence());
    EXPECT_EQ(all.efficiency(), GuidingEfficiency());
    all.add(of(8, 1, 2, 4));
    EXPECT_EQ(all, of(8, 1, 2, 4));
    all.add(of(24, 3, 6, 8));
    all.add({});
    EXPECT_NEAR(all.efficiency().guided_variance, 64 * 2.5, 1e-9);
    EXPECT_NEAR(all.efficiency().unguided_variance, 64 * 5, 1e-9);
    EXPECT_NEAR(all.efficiency().guided_cost, 7, 1e-9);
    EXPECT_NEAR(all.efficiency().efficiency, 4, 1e-9);
    EXPECT_EQ(all.samples, 32);
    // A group that knows it all in either pass: two of them in both.
    GuidingEvidence rare = of(8, 0, 0, 4), other = rare;
    rare.guided[3] = rare.unguided[3] = other.guided[9] = other.unguided[9] = 1;
    EXPECT_NEAR(rare.efficiency().known, 1, 1e-9);
    rare.add(other);
    EXPECT_NEAR(rare.efficiency().known, 2, 1e-9);
}

Guiding verdict(std::uint32_t spp, double efficiency, double error = 0, double mistrust = 1, double known = 20) {
    PassPlan pass;
    pass.spp = spp;
    return judge_guiding(pass, {.efficiency = efficiency, .error = error, .known = known}, {}, mistrust);
}

TEST(GuidingEfficiency, GuidingEndsWhereItSurelyLoses) {
    EXPECT_EQ(verdict(2, 0.1), Guiding::open) << "too short";
    EXPECT_EQ(verdict(64, 0), Guiding::open) << "not known";
    EXPECT_EQ(verdict(8, 0.8), Guiding::open) << "trees of short passes get better";
    EXPECT_EQ(verdict(8, 0.6), Guiding::loses);
    EXPECT_EQ(verdict(16, 0.76), Guiding::open);
    EXPECT_EQ(verdict(32, 0.81), Guiding::open) << "half way to passes whose trees hardly get better";
    EXPECT_EQ(verdict(32, 0.79), Guiding::loses);
    EXPECT_EQ(verdict(64, 0.81), Guiding::loses);
    EXPECT_EQ(verdict(512, 0.84), Guiding::loses);
    EXPECT_EQ(verdict(64, 0.95), Guiding::open);
    EXPECT_EQ(verdict(64, 0.8, 0.3), Guiding::open) << "0.8 may be 1.2";
    EXPECT_EQ(verdict(64, 0.5, 0.3), Guiding::loses);
    EXPECT_EQ(verdict(64, 0.5, 0.0, 1.0, 2.0), Guiding::open) << "a sample or two are all that is known";
    EXPECT_EQ(verdict(64, 0.5, 0.0, 3.0), Guiding::open) << "unguided passes were thrice as noisy as it was said";
}

/// A tree that is worth more than the one before is judged as it may become.
TEST(GuidingEfficiency, TreesThatGetBetterAreJudgedByTheNext) {
    const auto after = [](double before, double efficiency, std::uint32_t spp = 8, double error = 0) {
        PassPlan pass;
        pass.spp = spp;
        return judge_guiding(pass, {.efficiency = efficiency, .error = error, .known = 20},
                             {.efficiency = before, .known = 20}, 1);
    };
    EXPECT_EQ(after(0, 0.8), Guiding::open) << "the first that is known";
    EXPECT_EQ(after(0.78, 0.8), Guiding::open);
    EXPECT_EQ(after(0.78, 0.8, 64), Guiding::loses) << "0.82 is next";
    PassPlan pass;
    pass.spp = 64;
    EXPECT_EQ(judge_guiding(pass, {.efficiency = 0.8, .known = 20}, {.efficiency = 0.5, .known = 2}, 1), Guiding::loses)
        << "a sample or two are all that was known before";
    EXPECT_EQ(after(0.9, 0.8), Guiding::open) << "a noisy figure";
    EXPECT_EQ(after(0.9, 0.7), Guiding::loses);
    EXPECT_EQ(after(0.65, 0.7), Guiding::open) << "0.754 is next";
    EXPECT_EQ(after(1.2, 0.95), Guiding::open);
    EXPECT_EQ(after(0.9, 0.8, 8, 0.2), Guiding::open) << "0.8 may be 1.04";
    EXPECT_EQ(after(0.8, 0.7, 2), Guiding::open) << "too short";
    EXPECT_EQ(after(0.82, 0.83, 64), Guiding::loses) << "0.84 is next";
    EXPECT_EQ(after(0.80, 0.83, 64), Guiding::open) << "as much again is 0.861";
}

TEST(GuidingEfficiency, WhereGuidingLosesPassesAreUnguidedAndTeachNothing) {
    Job job;
    for (const GuidingType type : {GuidingType::automatic, GuidingType::view})
        for (const Guiding known : {Guiding::open, Guiding::loses}) {
            job.guiding.type = type;
            const Resolved resolved = test::resolved(job);
            PassPlan pass = make_pass(resolved, 3, 7, 8, false);
            if (known == Guiding::loses) pass = test::after_losing_pass(resolved, pass);
            const bool guided = type == GuidingType::view || known == Guiding::open;
            EXPECT_EQ(pass.guided, guided);
            EXPECT_EQ(pass.record, guided);
        }
}

/// A render of "auto", pass by pass.
class Automatic {
  public:
    Automatic() {
        Job job;
        job.guiding.type = GuidingType::automatic;
        job_ = test::resolved(job);
        state_ = first_state(job_, first_model(job_, Box3(Vec3(0.0f), Vec3(1.0f)), 1.0f), kSquare);
        const ImageLevels levels = even_levels();
        state_.tree.set_image({static_cast<std::uint32_t>(levels.columns), levels.inverse_levels, 0});
    }

    /// A pass whose samples deviate by this, and that tells of unguided ones, if it is guided. Returns the verdict.
    Guiding pass(float deviation, double unguided = 0, std::uint32_t spp = 64) {
        PassReport report;
        report.plan = make_pass(job_, index_++, 64, spp, false);
        Decisions::apply(report.plan, state_.history.decisions, true);
        report.stats.paths = kSquare * spp;
        report.stats.rays = 4 * report.stats.paths;
        Decisions::Evidence sums;
        if (report.plan.guided) sums.get<UnguidedSums>() = sums_of(double(deviation), unguided, 4.0, spp);
        state_.films.assign(1, {spp, 0, pixels(deviation, spp)});
        CombinedImage image;
        image.mean.assign(kSquare, Rgb64(1.0));
        judge(state_, job_, image, kEdge, sums, report);
        const Guiding verdict = report.decisions.get<GuidingVerdict>().guiding;
        EXPECT_EQ(verdict, state_.history.decisions.get<GuidingDecision::Memory>().verdict);
        guided = report.plan.guided;
        return verdict;
    }
    bool guided = true;  ///< the last pass

  private:
    Resolved job_;
    RenderState state_;
    std::uint32_t index_ = 1;
};

TEST(Automatic, GuidesAgainWhereUnguidedPassesAreNoisierThanGuidedOnesHadSaid) {
    Automatic render;
    EXPECT_EQ(render.pass(0.5f, 0.4), Guiding::loses) << "a light that nobody has met yet";
    EXPECT_EQ(render.pass(0.4f), Guiding::loses);
    EXPECT_FALSE(render.guided);
    EXPECT_EQ(render.pass(0.4f), Guiding::loses) << "as noisy as it was said to be";
    EXPECT_EQ(render.pass(4.0f), Guiding::open) << "a hundred times as noisy";
    EXPECT_FALSE(render.guided);
    EXPECT_EQ(render.pass(0.5f, 0.4), Guiding::open) << "guided paths still say the same, and are not believed";
    EXPECT_TRUE(render.guided);
    EXPECT_EQ(render.pass(0.5f, 4.0), Guiding::open) << "now they know";
    EXPECT_EQ(render.pass(0.5f, 0.4), Guiding::open) << "but this one has missed the light again";
}

TEST(Automatic, MistrustDoesNotLast) {
    Automatic render;
    EXPECT_EQ(render.pass(0.5f, 0.4), Guiding::loses);
    render.pass(4.0f);
    EXPECT_EQ(render.pass(4.0f), Guiding::open);
    Guiding last = Guiding::open;
    int passes = 0;
    for (; passes < 12 && last == Guiding::open; ++passes)
        last = render.pass(0.5f, 0.4);
    EXPECT_EQ(last, Guiding::loses);
    EXPECT_GT(passes, 1);
}

/// Passes of 64 spp at equal cost, in which some groups of pixels have such variances and the others none.
class Passes {
  public:
    GuidingVerdict guided(double guided, double unguided, std::size_t first = 0, std::size_t groups = 64) {
        GuidingEvidence evidence{.samples = double(pass_.spp), .guided_cost = 1, .unguided_cost = 1};
        std::fill_n(evidence.guided.begin() + std::ptrdiff_t(first), groups, guided / double(groups));
        std::fill_n(evidence.unguided.begin() + std::ptrdiff_t(first), groups, unguided / double(groups));
        ++pass_.index;
        return memory_.after_guided(pass_, evidence);
    }
    Guiding unguided(double variance) {
        ++pass_.index;
        return memory_.after_unguided(pass_, variance, Guiding::loses).guiding;
    }
    void set_spp(std::uint32_t spp) { pass_.spp = spp; }

  private:
    GuidingMemory memory_;
    PassPlan pass_{.spp = 64};
};

/// Rare light makes single groups of pixels outweigh all others in any pass.
TEST(GuidingMemory, PassesThatEachKnowTooLittleKnowEnoughTogether) {
    Passes passes;
    const GuidingVerdict first = passes.guided(2, 1, 0, 2), second = passes.guided(2, 1, 2, 2);
    EXPECT_NEAR(first.efficiency.known, 2, 1e-9);
    EXPECT_EQ(first.guiding, Guiding::open);
    EXPECT_NEAR(second.efficiency.known, 4, 1e-9);
    EXPECT_NEAR(second.efficiency.efficiency, 0.5, 1e-9);
    EXPECT_EQ(second.guiding, Guiding::loses);
}

TEST(GuidingMemory, APassThatHasMissedLightIsJudgedByAll) {
    Passes passes;
    EXPECT_EQ(passes.guided(10, 100).guiding, Guiding::open);
    const GuidingVerdict missed = passes.guided(2, 1);
    EXPECT_NEAR(missed.efficiency.unguided_variance, 50.5, 1e-9);
    EXPECT_EQ(missed.guiding, Guiding::open) << "by itself it would be worth a half";
    for (int pass = 0; pass < 120; ++pass)
        passes.guided(2, 1);
    EXPECT_EQ(passes.guided(2, 1).guiding, Guiding::loses) << "in the end that light was a firefly";
}

TEST(GuidingMemory, WhatShortPassesToldIsForgotten) {
    Passes passes;
    passes.set_spp(8);
    EXPECT_EQ(passes.guided(10, 100).guiding, Guiding::open);
    passes.set_spp(16);
    const GuidingVerdict settled = passes.guided(2, 1);
    EXPECT_NEAR(settled.efficiency.unguided_variance, 1, 1e-9);
    EXPECT_EQ(settled.guiding, Guiding::loses);
}

TEST(GuidingMemory, WaitsOnlyBeforeGuidingIsTakenUpAgain) {
    Passes passes;
    EXPECT_EQ(passes.guided(2, 1).guiding, Guiding::loses);
    EXPECT_EQ(passes.unguided(0), Guiding::loses) << "not known";
    EXPECT_EQ(passes.unguided(100), Guiding::open) << "the second";
    EXPECT_EQ(passes.guided(256, 128).guiding, Guiding::loses) << "all have told 64 of 100";
    EXPECT_EQ(passes.unguided(100), Guiding::loses);
    EXPECT_EQ(passes.unguided(100), Guiding::loses) << "which is the same but for chance";
    EXPECT_EQ(passes.unguided(400), Guiding::open);
}

TEST(Automatic, PassesTooShortToJudgeAreNothingToCompareWith) {
    Automatic render;
    EXPECT_EQ(render.pass(0.5f, 0.1, 2), Guiding::open);
    EXPECT_EQ(render.pass(0.5f, 0.533), Guiding::loses) << "worth 0.8, the first that is known";
}

TEST(Automatic, TheFirstUnguidedPassDoesNotTakeGuidingUp) {
    Automatic render;
    EXPECT_EQ(render.pass(0.5f, 0.4), Guiding::loses);
    EXPECT_EQ(render.pass(4.0f), Guiding::loses) << "the first pass after a change has no say";
    EXPECT_EQ(render.pass(4.0f), Guiding::open);
}

/// Whoever has seen no light has nothing to judge by, and stays where it is safe.
TEST(Automatic, AnImageWithoutLightStaysGuided) {
    Job job;
    job.guiding.type = GuidingType::automatic;
    const Resolved resolved = test::resolved(job);
    RenderState state = first_state(resolved, first_model(resolved, Box3(Vec3(0.0f), Vec3(1.0f)), 1.0f), kSquare);
    PassReport report;
    report.plan = make_pass(resolved, 1, 64, 64, false);
    report.stats.paths = 1000;
    report.stats.rays = 4000;
    state.films.assign(1, {kSamples, 0, std::vector<PixelEstimate>(kSquare)});
    CombinedImage image;
    image.mean.assign(kSquare, Rgb64(0.0));
    judge(state, resolved, image, kEdge, Decisions::Evidence(), report);
    EXPECT_EQ(report.decisions.get<GuidingVerdict>().guiding, Guiding::open);
    EXPECT_EQ(report.decisions.get<GuidingVerdict>().efficiency.efficiency, 0);
    EXPECT_TRUE(state.tree.regions().image.inverse_levels.empty());
    EXPECT_EQ(state.tree.regions().image.next_event, 0);
}

/// Paths of up to three steps: each goes left with the chance `a` (guided) or `b` (unguided), finds 1 on the left and 3
/// on the right, and ends. What guided paths tell is held against the unguided sum over all ways.
TEST(UnguidedEstimate, TellsTheSecondMomentAndCostOfUnguidedPaths) {
    constexpr double kGuided = 0.7, kUnguided = 0.2, kLeft = 0.9, kRight = 0.4;
    double truth = 0, true_cost = 0, told = 0, cost = 0;
    constexpr int kSteps = 3;
    for (int way = 0; way < (1 << kSteps); ++way) {
        double guided = 1, unguided = 1, found = 0, carried = 1;
        float throughput = 1.0f;
        UnguidedEstimate estimate;
        for (int step = 0; step < kSteps; ++step) {
            const bool left = way >> step & 1;
            const double p = left ? kGuided : 1 - kGuided, q = left ? kUnguided : 1 - kUnguided;
            estimate.add_cost(1.0f);
            guided *= p;
            unguided *= q;
            carried *= (left ? kLeft : kRight) / q;
            throughput *= static_cast<float>((left ? kLeft : kRight) / p);
            estimate.step(static_cast<float>(p), static_cast<float>(q));
            found += carried * (left ? 1.0 : 3.0);
            estimate.add(throughput * (left ? 1.0f : 3.0f));
        }
        truth += unguided * found * found;
        true_cost += unguided * kSteps;
        told += guided * double(estimate.moment());
        cost += guided * double(estimate.cost());
    }
    EXPECT_NEAR(told / truth, 1.0, 1e-5);
    EXPECT_NEAR(cost / true_cost, 1.0, 1e-5);
}

TEST(UnguidedEstimate, WhatUnguidedPathsNeverDoTellsNothing) {
    UnguidedEstimate estimate;
    estimate.step(0.5f, 0.0f);
    estimate.add(3.0f);
    estimate.add_cost(1.0f);
    EXPECT_EQ(estimate.moment(), 0.0f);
    EXPECT_EQ(estimate.cost(), 0.0f);
}

}  // namespace
}  // namespace treefarm
