// SPDX-License-Identifier: Apache-2.0
#include "report/study_page.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <span>

#include "report/effect_costs.h"
#include "report/html.h"
#include "report/page_assets.h"
#include "report/prediction_table.h"
#include "report/processor_fraction.h"
#include "report/study_charts.h"
#include "report/study_tables.h"
#include "report/tree_pictures.h"
#include "report/verdict.h"
#include "report/viewer_data.h"

namespace treefarm {

namespace {

/// Multiple of a reference's own error above which it is accurate enough.
constexpr double kReferenceMargin = 3;

std::string section(const std::string& title, const std::string& note, const std::string& content) {
    if (content.empty()) return "";
    return "<h3>" + title + "</h3>\n" + (note.empty() ? "" : "<p class=\"note\">" + note + "</p>\n") + content;
}

/// A section that is closed until a reader opens it.
std::string fold(const std::string& title, const std::string& note, const std::string& content) {
    if (content.empty()) return "";
    return "<details><summary>" + title + "</summary>\n" +
           (note.empty() ? "" : "<p class=\"note\">" + note + "</p>\n") + content + "</details>\n";
}

/// One part of the page for each clock; the switch at the top of the page shows one of them.
template <class Make>
std::string by_clock(Make make) {
    std::string html;
    for (const Clock& clock : clocks())
        if (const std::string part = make(clock); !part.empty())
            html += fmt::format("<div class=\"of-{}\">\n{}</div>\n", clock.key, part);
    return html;
}

std::string reference_note(const StudyResults& results, const SceneResult& scene) {
    if (!results.has_references)
        return "<p class=\"note\">No reference: errors are those that the renders estimated of themselves.</p>\n";
    std::string note = "Reference: " + html_text(scene.reference_file) +
                       (scene.reference_rendered ? ", rendered by another method and seed" : ", given");
    if (!std::isfinite(scene.reference_error))
        return "<p class=\"note\">" + note + "; its own error is not known.</p>\n";
    note += fmt::format("; its own error is estimated as {:.3g} % (RMSE / mean).", 100 * scene.reference_error);
    double least = INFINITY;
    for (const CellResult& cell : results.cells)
        if (cell.scene == scene.name) least = std::min(least, measures()[0].value(cell.passes.back()));
    std::string html = "<p class=\"note\">" + note + "</p>\n";
    if (least < kReferenceMargin * scene.reference_error)
        html += fmt::format(
            "<p class=\"warning\">Errors below {:.3g} % are partly the reference's own: render it with more "
            "samples.</p>\n",
            100 * kReferenceMargin * scene.reference_error);
    return html;
}

/// Convergence charts of some measures.
std::string charts(const StudyResults& results, const SceneResult& scene, std::span<const Measure> by) {
    return by_clock([&](const Clock& clock) {
        std::string pictures;
        for (const Measure& measure : by)
            if (const std::string svg = draw_svg(convergence_chart(results, scene, measure, clock)); !svg.empty())
                pictures += "<div>" + svg + "</div>\n";
        return pictures.empty() ? "" : "<div class=\"charts\">\n" + pictures + "</div>\n";
    });
}

std::string time_part(const StudyResults& results, const SceneResult& scene, const Measure& measure) {
    return by_clock([&](const Clock& clock) { return time_table(results, scene, measure, clock); });
}

std::string predictions(const StudyResults& results, const SceneResult& scene) {
    if (!results.has_references) return "";
    std::string pictures;
    for (const Picture& picture : {estimate_chart(results, scene), forecast_chart(results, scene)})
        if (!picture.script.empty()) pictures += "<div>" + draw_svg(picture) + "</div>\n";
    return fold("Predicted against actual",
                "Every pass of every cell: the error that it claimed, and when it said that half of it (or the "
                "error asked for) would be reached. \"At most\" is said while the tree still learns fast, "
                "\"roughly\" where the error itself is not known well; the pictures leave out the bounds.",
                prediction_table(results, scene) + "<div class=\"charts\">\n" + pictures + "</div>\n");
}

/// Measures besides the first: they weigh dark and bright pixels otherwise.
std::string other_measures(const StudyResults& results, const SceneResult& scene) {
    const std::span<const Measure> others = std::span(results.measured_by).subspan(1);
    if (others.empty()) return "";
    std::string html = by_clock([&](const Clock& clock) { return other_measures_table(results, scene, clock); }) +
                       charts(results, scene, others);
    for (const Measure& measure : others)
        html += section(std::string("Time to an error: ") + measure.name, "", time_part(results, scene, measure));
    return fold("Other measures",
                "Relative errors of each pixel: dark pixels count as much as bright ones. A claim should hold by all "
                "measures.",
                html);
}

/// HTML of one scene, for one budget.
std::string scene_part(const StudyResults& results, const SceneResult& scene) {
    const std::string name = results.measured_by.front().name;
    std::string html =
        section("Error at the end of the budget",
                "Error: " + name +
                    ", as --error counts it; geometric mean over seeds. Times as fast: to an equal "
                    "error, by the ratio of squared error times time, with its 95 % interval over pairs of seeds.",
                by_clock([&](const Clock& clock) { return headline_table(results, scene, clock); }));
    html += section("Error over time",
                    "Line: geometric mean over seeds; band: its 95 % interval, from three seeds on; points: passes.",
                    charts(results, scene, {results.measured_by.data(), 1}));
    html +=
        section("Images",
                "First seed. Wheel zooms, dragging moves, in all pictures at once; so do + and - and the arrows. In "
                "false colour: mean of |a - b| / (b + 0.01) over channels; black 0, white 1 at exposure 0.",
                viewer_data(results, scene));
    html += section("Trees",
                    "What treefarm inspect drew: learned distributions beside the true ones on the direction square "
                    "(logarithmic, three decades below white), and over the film.",
                    tree_pictures(results, scene));
    html +=
        fold("Time to an error",
             "Geometric mean with its 95 % interval over seeds, and &times; how many times as fast as the baseline. "
             "~ and grey: beyond what was rendered, extrapolated as the inverse square root of time from the last "
             "pass.",
             time_part(results, scene, results.measured_by.front()));
    html += other_measures(results, scene);
    html += fold("Further figures",
                 "Means over seeds. Share of the processors: core-seconds over seconds x threads while workers "
                 "traced; below 80 % something else had them, or workers waited for each other.",
                 figures_table(results, scene));
    html += fold("Nonzero paths and memory per pass",
                 "Share of camera paths that carried radiance; the tree on a worker, sampling form and sums.",
                 pass_table(results, scene));
    html += fold("Where the time went",
                 "Of the seconds of the coordinator's clock, mean over seeds; collect: workers trace.",
                 phase_table(results, scene));
    html += fold("Workers", "Thread-seconds tracing and recording, mean over seeds.", worker_table(results, scene));
    html += predictions(results, scene);
    return html + fold("Effect plans",
                       "What was simulated. Core-seconds with the effect over those without, where the study has "
                       "methods that differ only by that switch: 95 % interval over pairs of seeds.",
                       plan_tables(results, scene));
}

bool has_cells(const StudyResults& results, const SceneResult& scene) {
    return std::any_of(results.cells.begin(), results.cells.end(),
                       [&](const CellResult& cell) { return cell.scene == scene.name; });
}

std::string scene_parts(const StudyResults& results, const SceneResult& scene) {
    if (!has_cells(results, scene)) return "";
    std::string html = "<h2>" + html_text(scene.name) + "</h2>\n" + reference_note(results, scene);
    if (results.budgets.size() == 1) return html + scene_part(results, scene);
    html += section("Budget by budget", "Error at the end, and &times; how many times as fast as the baseline.",
                    by_clock([&](const Clock& clock) { return budget_table(results, scene, clock); }));
    for (const std::string& budget : results.budgets) {
        const StudyResults part = results.of_budget(budget);
        if (!has_cells(part, scene)) continue;
        html += "<h2>" + html_text(scene.name + ", " + budget) + "</h2>\n" + scene_part(part, scene);
    }
    return html;
}

std::string method_table(const StudyResults& results) {
    std::vector<std::vector<std::string>> rows = {{"method", "keys"}};
    for (const MethodResult& method : results.methods) {
        std::string keys;
        for (const auto& [key, value] : method.settings)
            keys += (keys.empty() ? "" : ", ") + html_text(fmt::format("{} = {}", key, value));
        rows.push_back({html_text(method.name) + (method.name == results.baseline ? " (baseline)" : ""),
                        keys.empty() ? "defaults" : keys});
    }
    return "<div class=\"keys\">" + html_table(rows) + "</div>\n";
}

/// Warning that seconds cannot be compared, if cells had different numbers of threads.
std::string thread_warning(const StudyResults& results) {
    std::set<int> threads;
    for (const CellResult& cell : results.cells)
        for (const PassRow& row : cell.passes)
            threads.insert(row.threads);
    if (threads.size() < 2) return "";
    return "<p class=\"warning\">Not all cells were rendered by the same number of threads: their seconds do not "
           "compare.</p>\n";
}

/// HTML of the page's summary.
std::string answer_part(const StudyResults& results) {
    return "<div class=\"answer\">\n" + by_clock([&](const Clock& clock) {
               std::string html;
               for (const std::string& line : answers(results, clock)) {
                   const std::size_t colon = line.find(": ");
                   html +=
                       "<p><b>" + html_text(line.substr(0, colon)) + "</b>" + html_text(line.substr(colon)) + "</p>\n";
               }
               return html;
           }) +
           "</div>\n";
}

/// Two buttons without a script: the style sheet shows the parts of the pressed one.
std::string clock_inputs(const Clock& chosen) {
    std::string html;
    for (const Clock& clock : clocks())
        html +=
            fmt::format("<input type=\"radio\" name=\"clock\" id=\"by-{}\" class=\"clock\" autocomplete=\"off\"{}>\n",
                        clock.key, &clock == &chosen ? " checked" : "");
    return html;
}

std::string clock_labels() {
    std::string html = "<p class=\"switch\">Time in";
    for (const Clock& clock : clocks())
        html += fmt::format(" <label for=\"by-{}\">{}</label>", clock.key, clock.name);
    return html + "</p>\n";
}

std::string budget_list(const StudyResults& results) {
    std::string text;
    for (const std::string& budget : results.budgets)
        text += (text.empty() ? "" : "; ") + budget;
    return text;
}

}  // namespace

std::string study_page(const StudyResults& results) {
    std::string html =
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"><title>" +
        html_text(results.folder.filename().string()) +
        ": what accuracy costs</title><link rel=\"icon\" href=\"data:,\"><style>\n" + kPageStyle +
        "</style></head><body>\n<h1>What accuracy costs</h1>\n";
    html += clock_inputs(main_clock(results)) + "<main>\n" + answer_part(results) + clock_labels();
    if (const std::string warning = busy_warning(results); !warning.empty())
        html += "<p class=\"warning\">" + html_text(warning) + "</p>\n";
    html += thread_warning(results);
    const std::string what = results.has_references
                                 ? fmt::format("Study {}: {} of {} cells, {} each. ", results.study,
                                               results.cells.size(), results.planned, budget_list(results))
                                 : "Renders " + results.study + ". ";
    html += "<p class=\"note\">" + html_text(what + provenance_text(results.cells)) + "</p>\n";
    html += method_table(results);
    for (const SceneResult& scene : results.scenes)
        html += scene_parts(results, scene);
    return html + "</main>\n<script>\n" + kViewerScript + "</script>\n</body></html>\n";
}

}  // namespace treefarm
