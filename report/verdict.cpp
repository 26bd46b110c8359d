// SPDX-License-Identifier: Apache-2.0
#include "report/verdict.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

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

/// "a, b or c"
std::string list_text(const std::vector<std::string>& names, const char* last = "or") {
    std::string text;
    for (std::size_t k = 0; k < names.size(); ++k)
        text += (k == 0 ? "" : k + 1 == names.size() ? fmt::format(" {} ", last) : ", ") + names[k];
    return text;
}

/// Results of the seeds that every method has in every one of the scenes, so that no method is ranked by easier seeds;
/// all of them if there is no such seed.
StudyResults of_shared_seeds(const StudyResults& results, std::span<const SceneResult> scenes) {
    std::set<std::string> methods;
    std::map<std::size_t, std::size_t> counts;  // of cells per repetition
    const auto is_meant = [&](const CellResult& cell) {
        return std::any_of(scenes.begin(), scenes.end(),
                           [&](const SceneResult& one) { return one.name == cell.scene; });
    };
    for (const CellResult& cell : results.cells)
        if (is_meant(cell)) {
            methods.insert(cell.method);
            ++counts[cell.repetition];
        }
    std::erase_if(counts, [&](const auto& of) { return of.second != methods.size() * scenes.size(); });
    StudyResults shared = results;
    if (!counts.empty())
        std::erase_if(shared.cells, [&](const CellResult& cell) { return !counts.contains(cell.repetition); });
    return shared;
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

/// Sentence for results without two methods to compare, with the folders of single renders.
std::string nothing_to_compare(const StudyResults& results) {
    std::vector<std::string> methods;
    for (const CellResult& cell : results.cells)
        if (std::find(methods.begin(), methods.end(), cell.method) == methods.end()) methods.push_back(cell.method);
    if (methods.size() > 1) return list_text(methods, "and") + " have no seed in common yet, and cannot be compared.";
    std::string text = "There is one method only, and nothing to compare it with";
    if (results.has_references || results.cells.size() < 2) return text + ".";
    std::vector<std::string> folders;
    for (const CellResult& cell : results.cells)
        folders.push_back(cell.folder.string());
    return text + fmt::format(": {} differ by seed or image size alone.", list_text(folders, "and"));
}

/// " Scenes disagree: in X B was 2 times as fast as A.", if another method than the best came out first in a scene.
std::string disagreement(const StudyResults& results, std::span<const SceneResult> scenes, const Measure& measure,
                         const Clock& clock, const std::string& best) {
    std::vector<std::string> others;
    bool surely = false;
    for (const SceneResult& scene : scenes) {
        const std::vector<Rival> rivals = ranking(results, {&scene, 1}, measure, clock);
        if (rivals.empty() || rivals.front().name == best) continue;
        const Interval over = gain(results, {&scene, 1}, rivals.front().name, best, measure, clock);
        if (!(over.mean > 1)) continue;
        surely = surely || differs_from_one(over);
        others.push_back(fmt::format("in {} {} was {} times as fast as {}", scene.name, rivals.front().name,
                                     interval_text(over), best));
    }
    if (others.empty()) return "";
    return fmt::format(" Scenes {}: {}.", surely ? "disagree" : "may disagree", list_text(others, "and"));
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

std::string verdict(const StudyResults& all, std::span<const SceneResult> scenes, const Clock& clock) {
    const StudyResults results = of_shared_seeds(all, scenes);
    const Measure& measure = results.measured_by.front();
    const std::vector<Rival> rivals = ranking(results, scenes, measure, clock);
    if (rivals.size() < 2) return nothing_to_compare(all);
    const std::string& best = rivals.front().name;
    const auto lead = [&](const std::string& over) { return gain(results, scenes, best, over, measure, clock); };
    const Interval next = lead(rivals[1].name);
    const std::string end = fmt::format(" (to equal {}, in {}; {})", measure.name, clock.name, seeds_text(next.values));
    if (next.values < kLeastSeeds)
        return fmt::format(
            "Cannot tell who won: {} {} nothing of chance, five or more would. {} came out first, {}{}{}.",
            seeds_text(next.values), next.values == 1 ? "says" : "say", best, times_as_fast(next), rivals[1].name, end);
    std::vector<std::string> equals, leads, slower;
    for (std::size_t k = 1; k < rivals.size(); ++k) {
        const std::string& name = rivals[k].name;
        const Interval over = lead(name);
        if (differs_from_one(over)) {
            slower.push_back(name);
            continue;
        }
        equals.push_back(name);
        leads.push_back(interval_text(over));
    }
    const bool beats_baseline = best != results.baseline && differs_from_one(rivals.front().gain);
    std::string text;
    if (equals.empty()) {
        text = best + " won: ";
        if (beats_baseline) text += times_as_fast(rivals.front().gain) + results.baseline;
        if (rivals[1].name != results.baseline)
            text += (beats_baseline ? ", " : "") + times_as_fast(next) + rivals[1].name + ", the next best";
        else if (!beats_baseline)
            text += times_as_fast(next) + rivals[1].name;
    } else if (beats_baseline) {
        for (std::size_t k = 0; k < equals.size(); ++k)
            leads[k] = fmt::format("{} ({})", equals[k], leads[k]);
        equals.insert(equals.begin(), best);
        text = fmt::format("{} won, which of them cannot be told: {} is {}{}, but its lead{} over {} may be chance",
                           list_text(equals), best, times_as_fast(rivals.front().gain), results.baseline,
                           leads.size() == 1 ? "" : "s", list_text(leads, "and"));
    } else {
        for (std::size_t k = 0; k < equals.size(); ++k)
            leads[k] += " times as fast as " + equals[k];
        text = fmt::format("Cannot tell who won: {} came out first, {}, which may be chance", best,
                           list_text(leads, "and"));
        if (!slower.empty())
            text += fmt::format("; {} {} surely slower", list_text(slower, "and"), slower.size() == 1 ? "is" : "are");
    }
    text += end + ".";
    if (rivals.size() > 2)
        text +=
            fmt::format(" Picked as the best of {} methods; the intervals are not corrected for that.", rivals.size());
    return text + disagreement(results, scenes, measure, clock, best) + contradictions(results, scenes, clock, best);
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
