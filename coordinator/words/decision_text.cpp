// SPDX-License-Identifier: Apache-2.0
#include "coordinator/words/decision_text.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "common/decide/guiding/guiding_constants.h"
#include "common/decide/next_event/next_event_constants.h"
#include "common/decide/splitting/splitting_constants.h"

namespace treefarm {

namespace {

/// "83 % of the work (between 75 and 89 %)"; without the bounds if they are equal in whole percents.
std::string saving(double saved, double at_least, double at_most) {
    const auto percent = [](double part) { return std::lround(100 * std::max(part, 0.0)); };
    std::string text = fmt::format("{} % of the work", percent(saved));
    if (percent(at_least) != percent(at_most))
        text += fmt::format(" (between {} and {} %)", percent(at_least), percent(at_most));
    return text;
}

/// "9 times the variance", or "about the same variance".
std::string variance_ratio(double ratio) {
    if (ratio > 0.95 && ratio < 1.05) return "about the variance";
    return fmt::format("{:.2g} times the variance", ratio);
}

DecisionText guiding(Guiding verdict, const GuidingEfficiency& w) {
    const bool guided = verdict != Guiding::loses;
    const auto saved = [guided](double efficiency) { return 1 - (guided ? 1 / efficiency : efficiency); };
    const double at_most = std::max(saved(w.low()), saved(w.high())),
                 at_least = std::min(saved(w.low()), saved(w.high()));
    const std::string why =
        fmt::format("an unguided sample would have {} of a guided one, at {:.2g} of its cost",
                    variance_ratio(w.unguided_variance / w.guided_variance), w.unguided_cost / w.guided_cost);
    const char* const what = guided ? "guided" : "unguided";
    const bool too_little = w.known < tuned<policy::kGuiding>("guiding.least_known");
    if (guided && (too_little || saved(w.efficiency) <= 0))
        return {
            "guiding",
            fmt::format("guided for now: {}{}; so far {}", too_little ? "too little is known" : "it may lose",
                        at_most > 0  ? fmt::format(", but may save up to {} % of the work", std::lround(100 * at_most))
                        : too_little ? ""
                                     : ", but not surely enough to give it up",
                        why)};
    if (saved(w.efficiency) <= 0)
        return {"guiding", fmt::format("unguided as long as guiding is not sure to pay again: {}", why)};
    if (std::lround(100 * saved(w.efficiency)) == 0)
        return {"guiding", fmt::format("{}, which costs as much as not: {}", what, why)};
    return {"guiding",
            fmt::format("{}, which saves {}: {}", what, saving(saved(w.efficiency), at_least, at_most), why)};
}

/// Adds the decision on next event, unless an emitter is sampled at nearly each vertex.
void add_next_event(const PassReport& r, std::vector<DecisionText>& texts) {
    const NextEventVerdict& verdict = r.decisions.get<NextEventDecision::Figures>().verdict;
    const bool saves = verdict.saved <= 0.98;
    if (!saves && (verdict.low < 0.005 || !r.plan.guided)) return;
    std::string words = "next event ";
    if (verdict.low < 0.005)
        words += "more rarely where it finds little";
    else
        words += fmt::format("at one vertex in 16 for {:.0f} % of them, where {}", 100 * verdict.low,
                             saves ? "it finds nearly nothing" : "guiding finds that light as well");
    if (saves)
        words +=
            fmt::format(", which saves about {:.0f} % of the work (by {:.2g} standard errors wherever it is rarer)",
                        100 * (1 - verdict.saved), tuned<policy::kNextEvent>("next_event.standard_errors"));
    texts.push_back({"next event", std::move(words)});
}

void add_splitting(const PassReport& r, std::vector<DecisionText>& texts) {
    const auto& [gain, pays] = r.decisions.get<SplittingDecision::Figures>();
    if (!r.plan.split || pays) return;
    std::string why = "unsplit samples would have " + variance_ratio(gain.variance);
    if (gain.variance >= tuned<policy::kSplitting>("splitting.least_quietened")) {
        why += fmt::format(" for {:.2g} of the rays", 1 / gain.rays);
        if (r.plan.next_event) why += ", and copies cost more than their rays";
    }
    texts.push_back({"splitting", "no path is split: " + why});
}

void add_light_subpaths(const PassReport& r, std::vector<DecisionText>& texts) {
    const auto& [gain, pays] = r.decisions.get<LightSubpathDecision::Figures>();
    const double quieter = gain.at_equal_cost();
    if (!has_light_subpaths(r.plan) || quieter == 0) return;
    const std::string noise =
        fmt::format("{:.2g} times {}", std::max(quieter, 1 / quieter), quieter < 1 ? "the variance" : "less variance");
    texts.push_back(
        {"light subpaths", fmt::format("{}paths from lamps make {} at equal cost, found by samples that have both",
                                       pays ? "" : "paths from the camera alone: ", noise)});
}

}  // namespace

std::vector<DecisionText> decision_texts(const PassReport& report) {
    std::vector<DecisionText> texts;
    const auto& [verdict, efficiency] = report.decisions.get<GuidingVerdict>();
    if (efficiency.efficiency > 0) texts.push_back(guiding(verdict, efficiency));
    add_next_event(report, texts);
    add_splitting(report, texts);
    add_light_subpaths(report, texts);
    return texts;
}

}  // namespace treefarm
