// SPDX-License-Identifier: Apache-2.0
#include "report/study_tables.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "report/figure_text.h"
#include "report/gain.h"
#include "report/html.h"
#include "report/processor_fraction.h"

namespace treefarm {

namespace {

constexpr double kTargets[] = {0.10, 0.05, 0.02, 0.01, 0.005};

template <class Get>
std::vector<double> values(const Cells& cells, Get get) {
    std::vector<double> list;
    for (const CellResult* cell : cells)
        list.push_back(get(*cell));
    return list;
}

template <class Get>
double mean(const Cells& cells, Get get) {
    double sum = 0;
    for (const CellResult* cell : cells)
        sum += get(*cell);
    return sum / static_cast<double>(cells.size());
}

/// A figure with a second line below it, for a narrow column.
std::string two_lines(const std::string& first, const std::string& second) {
    return first + "<br><small>" + second + "</small>";
}

/// gain_text() for a narrow column.
std::string gain_cell(const Interval& gain) {
    if (!std::isfinite(gain.mean)) return "?";
    const std::string text = gain_text(gain);
    const std::size_t blank = text.find(' ');
    if (blank == std::string::npos) return text;
    return two_lines(text.substr(0, blank), text.substr(blank + 1));
}

/// Whether two gains are significantly on opposite sides of 1: the choice of measure would decide the winner.
bool contradict(const Interval& a, const Interval& b) {
    return differs_from_one(a) && differs_from_one(b) && (a.mean > 1) != (b.mean > 1);
}

/// Accuracies that some method reached, and the next one; further ones would all be extrapolated.
std::vector<double> targets_of(const StudyResults& results, const SceneResult& scene, const Measure& measure) {
    std::vector<double> targets;
    for (const double target : kTargets) {
        targets.push_back(target);
        const bool reached = std::any_of(results.cells.begin(), results.cells.end(), [&](const CellResult& cell) {
            return cell.scene == scene.name && !time_to(curve_of(cell, measure), target).extrapolated;
        });
        if (!reached) break;
    }
    return targets;
}

}  // namespace

std::string headline_table(const StudyResults& results, const SceneResult& scene, const Clock& clock) {
    const Measure& measure = results.measured_by.front();
    const bool of_cores = &clock != &clocks().front();
    std::vector<std::vector<std::string>> rows = {{"method", "seeds", "samples per pixel",
                                                   of_cores ? "processor time" : "time", "error",
                                                   "times as fast as " + html_text(results.baseline)}};
    bool doubtful = false;
    for (const MethodResult& method : results.methods) {
        const Cells cells = results.of(scene.name, method.name);
        if (cells.empty()) continue;
        const auto last = [](auto get) { return [get](const CellResult& cell) { return get(cell.passes.back()); }; };
        const bool is_baseline = method.name == results.baseline;
        const auto gain_by = [&](const Measure& by) {
            return gain(results, {&scene, 1}, method.name, results.baseline, by, clock);
        };
        rows.push_back({html_text(method.name), std::to_string(cells.size()),
                        fmt::format("{:.4g}", mean(cells, last([](const PassRow& r) { return double(r.spp_done); }))),
                        time_text(mean(cells, last(clock.value)), of_cores),
                        percent_text(geometric_mean(values(cells, last(measure.value))).mean),
                        is_baseline ? "1" : gain_cell(gain_by(measure))});
        for (std::size_t a = 0; a < results.measured_by.size() && !doubtful; ++a)
            for (std::size_t b = 0; b < a && !doubtful; ++b)
                doubtful = contradict(gain_by(results.measured_by[a]), gain_by(results.measured_by[b]));
    }
    std::string html = html_table(rows);
    if (doubtful)
        html +=
            "<p class=\"warning\">By other measures another method wins (see \"Other measures\"): claim none of them "
            "alone.</p>\n";
    return html;
}

std::string other_measures_table(const StudyResults& results, const SceneResult& scene, const Clock& clock) {
    std::vector<std::vector<std::string>> rows = {{"method"}};
    for (std::size_t m = 1; m < results.measured_by.size(); ++m) {
        rows[0].push_back(results.measured_by[m].name);
        rows[0].push_back("times as fast as " + html_text(results.baseline));
    }
    for (const MethodResult& method : results.methods) {
        const Cells cells = results.of(scene.name, method.name);
        if (cells.empty()) continue;
        rows.push_back({html_text(method.name)});
        for (std::size_t m = 1; m < results.measured_by.size(); ++m) {
            const Measure& measure = results.measured_by[m];
            const auto last = [&](const CellResult& cell) { return measure.value(cell.passes.back()); };
            rows.back().push_back(percent_text(geometric_mean(values(cells, last)).mean));
            rows.back().push_back(method.name == results.baseline ? "1"
                                                                  : gain_cell(gain(results, {&scene, 1}, method.name,
                                                                                   results.baseline, measure, clock)));
        }
    }
    return rows[0].size() < 2 ? "" : html_table(rows);
}

std::string figures_table(const StudyResults& results, const SceneResult& scene) {
    std::vector<std::vector<std::string>> rows = {
        {"method", "seconds", "core-seconds", "share of the processors", "MAPE", "FLIP", "outliers"}};
    for (const MethodResult& method : results.methods) {
        const Cells cells = results.of(scene.name, method.name);
        if (cells.empty()) continue;
        const auto last = [](auto get) { return [get](const CellResult& cell) { return get(cell.passes.back()); }; };
        const auto measured = [&](const char* key) {
            return mean(cells, last([key](const PassRow& row) { return row.measured.at(key); }));
        };
        const double fraction = mean(cells, processor_fraction);
        rows.push_back({html_text(method.name), fmt::format("{:.3g}", mean(cells, last(clocks()[0].value))),
                        fmt::format("{:.3g}", mean(cells, last(clocks()[1].value))),
                        std::isfinite(fraction) ? fmt::format("{:.0f} %", 100 * fraction) : "?"});
        if (!results.has_references) continue;
        rows.back().push_back(percent_text(measured("mape")));
        rows.back().push_back(fmt::format("{:.3g}", mean(cells, [](const CellResult& cell) { return cell.flip; })));
        rows.back().push_back(fmt::format("{:.3g}", measured("outliers")));
    }
    rows[0].resize(rows.back().size());
    return html_table(rows);
}

std::string time_table(const StudyResults& results, const SceneResult& scene, const Measure& measure,
                       const Clock& clock) {
    const bool of_cores = &clock != &clocks().front();
    const std::vector<double> targets = targets_of(results, scene, measure);
    std::vector<std::vector<std::string>> rows = {{"method"}};
    for (const double target : targets)
        rows[0].push_back("to " + percent_text(target));
    for (const MethodResult& method : results.methods) {
        const auto [base, own] = paired(results.of(scene.name, results.baseline), results.of(scene.name, method.name));
        if (own.empty()) continue;
        std::vector<std::string> row = {html_text(method.name)};
        for (const double target : targets) {
            bool beyond = false;
            const auto time = [&](const CellResult& cell) {
                const Crossing at = time_to(curve_of(cell, measure, clock), target);
                beyond = beyond || at.extrapolated;
                return at.seconds;
            };
            const std::vector<double> a = values(base, time), b = values(own, time);
            const std::string seconds = time_text(geometric_mean(b), of_cores);
            const std::size_t interval = seconds.find(" [");
            std::string text = interval == std::string::npos
                                   ? seconds
                                   : two_lines(seconds.substr(0, interval), seconds.substr(interval + 1));
            if (method.name != results.baseline) text += "<br>&times;" + gain_cell(geometric_ratio(a, b));
            row.push_back(beyond ? "<span class=\"beyond\">~" + text + "</span>" : text);
        }
        rows.push_back(row);
    }
    return html_table(rows);
}

std::string budget_table(const StudyResults& results, const SceneResult& scene, const Clock& clock) {
    const Measure& measure = results.measured_by.front();
    std::vector<std::vector<std::string>> rows = {{"method"}};
    for (const MethodResult& method : results.methods)
        rows.push_back({html_text(method.name)});
    for (const std::string& budget : results.budgets) {
        const StudyResults part = results.of_budget(budget);
        rows[0].push_back(html_text(budget));
        for (std::size_t m = 0; m < results.methods.size(); ++m) {
            const std::string& method = results.methods[m].name;
            const Cells cells = part.of(scene.name, method);
            std::string text;
            if (!cells.empty())
                text = percent_text(geometric_mean(values(cells, [&](const CellResult& cell) {
                                        return measure.value(cell.passes.back());
                                    })).mean);
            if (!cells.empty() && method != results.baseline)
                text += "<br>&times;" + gain_cell(gain(part, {&scene, 1}, method, results.baseline, measure, clock));
            rows[m + 1].push_back(text);
        }
    }
    return html_table(rows);
}

std::string pass_table(const StudyResults& results, const SceneResult& scene) {
    std::vector<std::vector<std::string>> rows = {{"pass"}};
    std::size_t most = 0;
    for (const MethodResult& method : results.methods)
        for (const CellResult* cell : results.of(scene.name, method.name))
            most = std::max(most, cell->passes.size());
    for (std::size_t pass = 0; pass < most; ++pass)
        rows.push_back({std::to_string(pass + 1)});
    for (const MethodResult& method : results.methods) {
        rows[0].push_back(html_text(method.name) + "<br>nonzero paths");
        rows[0].push_back(html_text(method.name) + "<br>memory [MB]");
        for (std::size_t pass = 0; pass < most; ++pass) {
            Cells with;
            for (const CellResult* cell : results.of(scene.name, method.name))
                if (pass < cell->passes.size()) with.push_back(cell);
            const auto figure = [&](auto get) {
                return mean(with, [&](const CellResult& cell) { return get(cell.passes[pass]); });
            };
            rows[pass + 1].push_back(
                with.empty() ? "" : percent_text(figure([](const PassRow& row) { return row.nonzero_share; })));
            rows[pass + 1].push_back(with.empty() ? "" : fmt::format("{:.3g}", 1e-6 * figure([](const PassRow& row) {
                                                                                   return row.tree_memory;
                                                                               })));
        }
    }
    return html_table(rows);
}

std::string phase_table(const StudyResults& results, const SceneResult& scene) {
    constexpr const char* phases[] = {"broadcast", "collect", "refine", "film", "error"};
    std::vector<std::vector<std::string>> rows = {{"method"}};
    rows[0].insert(rows[0].end(), std::begin(phases), std::end(phases));
    for (const MethodResult& method : results.methods) {
        const Cells cells = results.of(scene.name, method.name);
        if (cells.empty()) continue;
        std::vector<double> seconds;
        double all = 0;
        for (const char* phase : phases) {
            seconds.push_back(mean(cells, [&](const CellResult& cell) {
                double sum = 0;
                for (const PassRow& row : cell.passes)
                    if (const auto at = row.phases.find(phase); at != row.phases.end()) sum += at->second;
                return sum;
            }));
            all += seconds.back();
        }
        rows.push_back({html_text(method.name)});
        for (const double part : seconds)
            rows.back().push_back(
                two_lines(fmt::format("{:.1f} %", all > 0 ? 100 * part / all : 0.0), fmt::format("{:.3g} s", part)));
    }
    return html_table(rows);
}

std::string worker_table(const StudyResults& results, const SceneResult& scene) {
    std::vector<std::vector<std::string>> rows = {{"method", "idle"}};
    std::vector<std::string> workers;
    for (const CellResult& cell : results.cells)
        for (const PassRow& row : cell.passes)
            for (const auto& [worker, seconds] : row.worker_seconds)
                if (std::find(workers.begin(), workers.end(), worker) == workers.end()) workers.push_back(worker);
    for (const std::string& worker : workers)
        rows[0].push_back("worker " + html_text(worker));
    for (const MethodResult& method : results.methods) {
        const Cells cells = results.of(scene.name, method.name);
        if (cells.empty()) continue;
        const auto total = [&](auto get) {
            return fmt::format("{:.3g}", mean(cells, [&](const CellResult& cell) {
                                   double sum = 0;
                                   for (const PassRow& row : cell.passes)
                                       sum += get(row);
                                   return sum;
                               }));
        };
        std::vector<std::string> row = {html_text(method.name), total([](const PassRow& r) { return r.idle_seconds; })};
        for (const std::string& worker : workers)
            row.push_back(total([&](const PassRow& r) {
                const auto at = r.worker_seconds.find(worker);
                return at == r.worker_seconds.end() ? 0.0 : at->second;
            }));
        rows.push_back(row);
    }
    return html_table(rows);
}

}  // namespace treefarm
