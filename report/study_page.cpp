#include "report/study_page.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "common/image/atomic_file.h"
#include "common/image/exr.h"
#include "report/effect_costs.h"
#include "report/html.h"
#include "report/page_assets.h"
#include "report/prediction_table.h"
#include "report/study_charts.h"
#include "report/study_csv.h"
#include "report/study_tables.h"
#include "report/tree_pictures.h"

namespace treefarm {

namespace {

/// Images in the page are no larger than this, in pixels.
constexpr int kLongestSide = 640;

/// A reference is good for errors of so many times its own.
constexpr double kReferenceMargin = 3;

std::string section(const std::string& title, const std::string& note, const std::string& content) {
    if (content.empty()) return "";
    return "<h3>" + title + "</h3>\n" + (note.empty() ? "" : "<p class=\"note\">" + note + "</p>\n") + content;
}

nlohmann::json viewer_image(const std::string& name, const std::string& caption, const std::filesystem::path& file) {
    const RgbImage image = reduced(read_exr_rgb(file).image, kLongestSide);
    return {{"name", name},
            {"caption", caption},
            {"width", image.width},
            {"height", image.height},
            {"rgbe", base64_rgbe(image)}};
}

/// Each method's image of the first seed, and the reference.
std::string viewer(const StudyResults& results, const SceneResult& scene) {
    nlohmann::json images = nlohmann::json::array();
    for (const MethodResult& method : results.methods) {
        const auto cells = results.of(scene.name, method.name);
        if (cells.empty()) continue;
        const PassRow& last = cells.front()->passes.back();
        images.push_back(
            viewer_image(method.name,
                         fmt::format("{:.3g} s, {} spp, root of relMSE {:.3g} % (trimmed {:.3g} %), FLIP {:.3g}",
                                     last.run_seconds, last.spp_done, 100 * measures()[1].value(last),
                                     100 * measures()[2].value(last), cells.front()->flip),
                         cells.front()->folder / "image.exr"));
    }
    images.push_back(viewer_image("reference", scene.reference_rendered ? "rendered" : "given", scene.reference_file));
    std::string json =
        images.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);  // text in a script ends at "</"
    for (std::size_t at = 0; (at = json.find("</", at)) != std::string::npos; at += 3)
        json.replace(at, 2, "<\\/");
    return "<div class=\"viewer\"><script type=\"application/json\">" + json + "</script></div>\n";
}

std::string reference_note(const StudyResults& results, const SceneResult& scene) {
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

std::string scene_part(const StudyResults& results, const SceneResult& scene) {
    if (std::none_of(results.cells.begin(), results.cells.end(),
                     [&](const CellResult& cell) { return cell.scene == scene.name; }))
        return "";
    std::string html = "<h2>" + html_text(scene.name) + "</h2>\n" + reference_note(results, scene);
    html += section("At the end of the budget",
                    "Gain: how many times as efficient as the baseline, the ratio of squared error times seconds, with "
                    "its 95 % interval over pairs of seeds. A claim needs both columns.",
                    final_table(results, scene));
    html += section("Images",
                    "First seed. Wheel zooms, dragging moves, in all pictures at once. In false colour: mean "
                    "of |a - b| / (b + 0.01) over channels; black 0, white 1 at exposure 0.",
                    viewer(results, scene));
    for (const Measure& measure : measures()) {
        html += section(std::string("Error over time: ") + measure.name,
                        "Line: geometric mean over seeds; band: its 95 % interval; points: passes.",
                        convergence_chart(results, scene, measure));
        html += section(std::string("Time to an error: ") + measure.name,
                        "With 95 % interval over seeds, and how many times as fast as the baseline. ~ and grey: beyond "
                        "what was rendered, extrapolated as the inverse square root of time from the last pass.",
                        time_table(results, scene, measure));
    }
    html += section("Nonzero paths and memory per pass",
                    "Share of camera paths that carried radiance; the tree on a worker, sampling form and sums.",
                    pass_table(results, scene));
    html += section("Trees",
                    "What treefarm inspect drew: learned distributions beside the true ones on the direction square "
                    "(logarithmic, three decades below white), and over the film.",
                    tree_pictures(results, scene));
    html += section("Where the time went", "Seconds of the coordinator's clock, mean over seeds; collect: tracing.",
                    phase_chart(results, scene));
    html += section("Workers", "Thread-seconds tracing and recording, mean over seeds.", worker_table(results, scene));
    html += section("Predicted against actual",
                    "Every pass of every cell: the error that it claimed, and when it said that half of it (or the "
                    "error asked for) would be reached. \"At most\" is said while the tree still learns fast, "
                    "\"roughly\" where the error itself is not known well; the pictures leave out the bounds.",
                    prediction_table(results, scene) + "<div class=\"pair\">" + estimate_chart(results, scene) +
                        forecast_chart(results, scene) + "</div>\n");
    return html + section("Effect plans",
                          "What was simulated. Core-seconds with the effect over those without, where the study has "
                          "methods that differ only by that switch: 95 % interval over pairs of seeds.",
                          plan_tables(results, scene));
}

std::string method_table(const StudyResults& results) {
    std::vector<std::vector<std::string>> rows = {{"method", "keys"}};
    for (const MethodResult& method : results.methods) {
        std::string keys;
        for (const auto& [key, value] : method.settings)
            keys += (keys.empty() ? "" : ", ") + html_text(key + " = " + value);
        rows.push_back({html_text(method.name) + (method.name == results.baseline ? " (baseline)" : ""),
                        keys.empty() ? "defaults" : keys});
    }
    return "<div class=\"keys\">" + html_table(rows) + "</div>\n";
}

/// Cells that were rendered by different numbers of threads cannot be compared by time.
std::string thread_warning(const StudyResults& results) {
    std::set<int> threads;
    for (const CellResult& cell : results.cells)
        for (const PassRow& row : cell.passes)
            threads.insert(row.threads);
    if (threads.size() < 2) return "";
    return "<p class=\"warning\">Not all cells were rendered by the same number of threads: their seconds do not "
           "compare.</p>\n";
}

void write_text(const std::filesystem::path& path, const std::string& text) {
    write_file_atomically(path, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

}  // namespace

std::string study_page(const StudyResults& results) {
    std::string html = "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>" +
                       html_text(results.folder.filename().string()) +
                       "</title><link rel=\"icon\" href=\"data:,\"><style>\n" + kPageStyle +
                       "</style></head><body>\n<h1>What accuracy costs</h1>\n";
    html += fmt::format("<p>Study {}: {} of {} cells, {} each, by {} threads.</p>\n", html_text(results.study),
                        results.cells.size(), results.planned, html_text(results.budget),
                        results.cells.front().passes.back().threads);
    html += thread_warning(results) + method_table(results);
    for (const SceneResult& scene : results.scenes)
        html += scene_part(results, scene);
    return html + "<script>\n" + kViewerScript + "</script>\n</body></html>\n";
}

std::filesystem::path write_study_report(const std::filesystem::path& folder) {
    const StudyResults results = read_study_results(folder);
    write_text(folder / "cells.csv", cells_csv(results));
    write_text(folder / "passes.csv", passes_csv(results));
    write_text(folder / "report.html", study_page(results));
    return folder / "report.html";
}

}  // namespace treefarm
