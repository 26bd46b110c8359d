// SPDX-License-Identifier: Apache-2.0
#include "report/verdict.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "report/figure_text.h"
#include "report/gain.h"
#include "report/processor_fraction.h"

namespace treefarm {

namespace {

constexpr double kTarget = 0.05;

/// A method with its gain, for a ranking.
struct Rival {
    std::string name;
    Interval gain;
};

std::string list_text(const std::vector<std::string>& names) {
    std::string text;
    for (std::size_t k = 0; k < names.size(); ++k)
        text += (k == 0 ? "" : k + 1 == names.size() ? " or " : ", ") + names[k];
    return text;
}

/// Methods by their gain over the baseline, the best first.
std::vector<Rival> ranking(const StudyResults& results, std::span<const SceneResult> scenes, const Measure& measure,
                           const Clock& clock) {
    std::vector<Rival> rivals;
    for (const MethodResult& method : results.methods) {
        const Interval over = gain(results, scenes, method.name, results.baseline, measure, clock);
        if (std::isfinite(over.mean)) rivals.push_back({method.name, over});
    }
    std::stable_sort(rivals.begin(), rivals.end(),
                     [](const Rival& a, const Rival& b) { return a.gain.mean > b.gain.mean; });
    return rivals;
}

/// "; by root of relMSE X is better than it", if another measure significantly contradicts.
std::string contradictions(const StudyResults& results, std::span<const SceneResult> scenes, const Clock& clock,
                           const std::string& best) {
    std::string text;
    for (std::size_t m = 1; m < results.measured_by.size(); ++m) {
        std::vector<std::string> better;
        for (const MethodResult& method : results.methods) {
            const Interval over = gain(results, scenes, best, method.name, results.measured_by[m], clock);
            if (differs_from_one(over) && over.high < 1) better.push_back(method.name);
        }
        if (!better.empty())
            text += fmt::format(" But by {} {} {} better than it: claim neither.", results.measured_by[m].name,
                                list_text(better), better.size() == 1 ? "is" : "are");
    }
    return text;
}

std::string times_as_fast(const Interval& gain) {
    return fmt::format("{} times as fast as ", interval_text(gain));
}

/// A method's time to the target, or the error that it reached.
std::string price(const StudyResults& results, const SceneResult& scene, const std::string& method,
                  const Clock& clock) {
    const Measure& measure = results.measured_by.front();
    const bool of_cores = &clock != &clocks().front();
    std::vector<double> times, errors, ends;
    bool reached = true;
    for (const CellResult* cell : results.of(scene.name, method)) {
        const Crossing at = time_to(curve_of(*cell, measure, clock), kTarget);
        reached = reached && !at.extrapolated;
        times.push_back(at.seconds);
        errors.push_back(measure.value(cell->passes.back()));
        ends.push_back(clock.value(cell->passes.back()));
    }
    if (times.empty()) return "";
    if (reached) return fmt::format("5 % error took {} {}", method, time_text(geometric_mean(times), of_cores));
    return fmt::format("{} came down to {} error in {}, not {}to 5 %", method,
                       percent_text(geometric_mean(errors).mean), time_text(geometric_mean(ends).mean, of_cores),
                       geometric_mean(errors).mean <= kTarget ? "with every seed " : "");
}

}  // namespace

std::string verdict(const StudyResults& results, std::span<const SceneResult> scenes, const Clock& clock) {
    const Measure& measure = results.measured_by.front();
    const std::vector<Rival> rivals = ranking(results, scenes, measure, clock);
    if (rivals.size() < 2) return "There is one method only, and nothing to compare it with.";
    const std::string& best = rivals.front().name;
    const auto lead = [&](const std::string& over) { return gain(results, scenes, best, over, measure, clock); };
    const Interval next = lead(rivals[1].name);
    const std::string end = fmt::format(" (to equal {}, in {}; {})", measure.name, clock.name, seeds_text(next.values));
    if (next.values < kLeastSeeds)
        return fmt::format(
            "Cannot tell who won: {} {} nothing of chance, five or more would. {} came out first, {}{}{}.",
            seeds_text(next.values), next.values == 1 ? "says" : "say", best, times_as_fast(next), rivals[1].name, end);
    std::vector<std::string> equals = {best};
    for (std::size_t k = 1; k < rivals.size(); ++k)
        if (!differs_from_one(lead(rivals[k].name))) equals.push_back(rivals[k].name);
    const bool baseline_is_first = best == results.baseline;
    const bool beats_baseline = !baseline_is_first && differs_from_one(rivals.front().gain);
    std::string text;
    if (equals.size() == 1) {
        text = best + " won: " +
               (baseline_is_first ? times_as_fast(next) + rivals[1].name + ", the next best"
                                  : times_as_fast(rivals.front().gain) + results.baseline);
        if (!baseline_is_first && rivals[1].name != results.baseline)
            text += ", " + times_as_fast(next) + rivals[1].name + ", the next best";
    } else if (beats_baseline) {
        text = fmt::format("{} won, which of them cannot be told: {} is {}{}, but its lead over {} ({}) may be chance",
                           list_text(equals), best, times_as_fast(rivals.front().gain), results.baseline,
                           rivals[1].name, interval_text(next));
    } else {
        text = fmt::format("Cannot tell who won: {} came out first, {}{}, which may be chance", best,
                           times_as_fast(next), rivals[1].name);
    }
    return text + end + "." + contradictions(results, scenes, clock, best);
}

std::string price_of_five_percent(const StudyResults& results, const SceneResult& scene, const Clock& clock) {
    const std::vector<Rival> rivals = ranking(results, {&scene, 1}, results.measured_by.front(), clock);
    const std::string best = rivals.empty() ? results.baseline : rivals.front().name;
    std::string text = price(results, scene, best, clock);
    if (best != results.baseline)
        if (const std::string base = price(results, scene, results.baseline, clock); !base.empty())
            text += (text.empty() ? "" : "; ") + base;
    return text.empty() ? "" : text + ".";
}

std::vector<std::string> answers(const StudyResults& results, const Clock& clock) {
    std::vector<std::string> lines;
    for (const std::string& budget : results.budgets) {
        const StudyResults part = results.of_budget(budget);
        if (part.cells.empty()) continue;
        std::vector<SceneResult> scenes;
        for (const SceneResult& scene : part.scenes)
            if (std::any_of(part.cells.begin(), part.cells.end(), [&](const auto& c) { return c.scene == scene.name; }))
                scenes.push_back(scene);
        const std::string at = results.budgets.size() > 1 ? ", " + budget : "";
        if (scenes.size() > 1) lines.push_back("All scenes" + at + ": " + verdict(part, scenes, clock));
        for (const SceneResult& scene : scenes)
            lines.push_back(scene.name + at + ": " + verdict(part, {&scene, 1}, clock) + " " +
                            price_of_five_percent(part, scene, clock));
    }
    return lines;
}

const Clock& main_clock(const StudyResults& results) {
    return was_busy(results) ? clocks()[1] : clocks()[0];
}

}  // namespace treefarm
