// SPDX-License-Identifier: Apache-2.0
#include "coordinator/words/decision_text.h"

#include <gtest/gtest.h>

#include <cmath>

namespace treefarm {
namespace {

/// All that is said of a subject; "" where nothing is.
std::string words_of(const PassReport& report, const std::string& subject) {
    for (const DecisionText& text : decision_texts(report))
        if (text.subject == subject) return text.words;
    return "";
}

PassReport guided_report() {
    PassReport report;
    report.plan.guided = true;
    report.decisions.get<GuidingVerdict>().efficiency = {.efficiency = 6,
                                                         .error = std::log(1.5),
                                                         .known = 20,
                                                         .unguided_variance = 18,
                                                         .guided_variance = 2,
                                                         .unguided_cost = 3,
                                                         .guided_cost = 4.5};
    return report;
}

TEST(DecisionText, OnGuidingSaysWhatItSavesHowSurelyAndWhy) {
    PassReport report = guided_report();
    const std::string why = "an unguided sample would have 9 times the variance of a guided one, at 0.67 of its cost";
    EXPECT_EQ(words_of(report, "guiding"), "guided, which saves 83 % of the work (between 75 and 89 %): " + why);
    report.decisions.get<GuidingVerdict>().guiding = Guiding::loses;
    EXPECT_EQ(words_of(report, "guiding"), "unguided as long as guiding is not sure to pay again: " + why);
    report.decisions.get<GuidingVerdict>().efficiency.efficiency = 0.4;
    EXPECT_EQ(words_of(report, "guiding"), "unguided, which saves 60 % of the work (between 40 and 73 %): " + why);
    report.decisions.get<GuidingVerdict>().guiding = Guiding::open;
    EXPECT_EQ(words_of(report, "guiding"),
              "guided for now: it may lose, but not surely enough to give it up; so far " + why);
}

TEST(DecisionText, ABoundThatSaysNothingMoreIsLeftOut) {
    PassReport report = guided_report();
    report.decisions.get<GuidingVerdict>().guiding = Guiding::loses;
    report.decisions.get<GuidingVerdict>().efficiency.efficiency = 0.71;
    report.decisions.get<GuidingVerdict>().efficiency.error = 1e-4;
    report.decisions.get<GuidingVerdict>().efficiency.unguided_variance = 2.01;
    EXPECT_EQ(words_of(report, "guiding"),
              "unguided, which saves 29 % of the work: an unguided sample would have about the variance of a guided "
              "one, at 0.67 of its cost");
}

TEST(DecisionText, NothingIsSavedByWhatCostsTheSame) {
    PassReport report = guided_report();
    report.decisions.get<GuidingVerdict>().efficiency.efficiency = 1.001;
    report.decisions.get<GuidingVerdict>().efficiency.error = 1e-4;
    EXPECT_TRUE(words_of(report, "guiding").starts_with("guided, which costs as much as not: "));
}

TEST(DecisionText, GuidedForWantOfKnowledgeSaysSo) {
    PassReport report = guided_report();
    report.decisions.get<GuidingVerdict>().efficiency.efficiency = 0.67;
    report.decisions.get<GuidingVerdict>().efficiency.error = 3;
    report.decisions.get<GuidingVerdict>().efficiency.known = 1.02;
    const std::string words = words_of(report, "guiding");
    EXPECT_TRUE(words.starts_with("guided for now: too little is known, but may save up to 93 % of the work; so far "))
        << words;
}

TEST(DecisionText, OnNextEventWhereItIsSaved) {
    PassReport report;
    report.decisions.get<NextEventDecision::Figures>().verdict = {0.99, 0.0};
    EXPECT_EQ(words_of(report, "next event"), "");
    report.decisions.get<NextEventDecision::Figures>().verdict = {1.02, 0.4};
    report.plan.guided = true;
    EXPECT_EQ(words_of(report, "next event"),
              "next event at one vertex in 16 for 40 % of them, where guiding finds that light as well");
    report.plan.guided = false;
    EXPECT_EQ(words_of(report, "next event"), "");
    report.decisions.get<NextEventDecision::Figures>().verdict = {0.69, 0.62};
    const std::string sure = " % of the work (by 2 standard errors wherever it is rarer)";
    EXPECT_EQ(
        words_of(report, "next event"),
        "next event at one vertex in 16 for 62 % of them, where it finds nearly nothing, which saves about 31" + sure);
    report.decisions.get<NextEventDecision::Figures>().verdict = {0.8, 0};
    EXPECT_EQ(words_of(report, "next event"),
              "next event more rarely where it finds little, which saves about 20" + sure);
}

TEST(DecisionText, OnSplittingOnceItIsGivenUp) {
    PassReport report;
    report.plan.split = report.plan.next_event = true;
    report.decisions.get<SplittingDecision::Figures>().gain = {1.02, 1.25, 1};
    EXPECT_EQ(words_of(report, "splitting"), "");
    report.decisions.get<SplittingDecision::Figures>().pays = false;
    EXPECT_EQ(words_of(report, "splitting"),
              "no path is split: unsplit samples would have about the variance for 0.8 of the rays, and "
              "copies cost more than their rays");
    report.plan.next_event = false;
    EXPECT_EQ(words_of(report, "splitting"),
              "no path is split: unsplit samples would have about the variance for 0.8 of the rays");
    report.decisions.get<SplittingDecision::Figures>().gain.variance = 1;
    EXPECT_EQ(words_of(report, "splitting"), "no path is split: unsplit samples would have about the variance")
        << "whatever the rays";
}

TEST(DecisionText, OnLightSubpathsOnlyOfSamplesThatHaveThem) {
    PassReport report;
    report.decisions.get<LightSubpathDecision::Figures>().gain = {.noise = 6.8, .rays = 2, .mean_ratio = 1};
    EXPECT_EQ(words_of(report, "light subpaths"), "") << "a path tracer has none";
    report.plan.layers.splats.pixels = 64;
    EXPECT_EQ(words_of(report, "light subpaths"),
              "paths from lamps make 2 times less variance at equal cost, found by samples that have both");
}

}  // namespace
}  // namespace treefarm
