#include "report/study_tables.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "report/html.h"

namespace treefarm {

namespace {

constexpr double kTargets[] = {0.10, 0.05, 0.02, 0.01, 0.005};

using Cells = std::vector<const CellResult*>;

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

/// Cells of both methods that share a repetition.
std::pair<Cells, Cells> paired(const Cells& a, const Cells& b) {
    std::pair<Cells, Cells> pairs;
    for (const CellResult* one : a)
        for (const CellResult* other : b)
            if (one->repetition == other->repetition) {
                pairs.first.push_back(one);
                pairs.second.push_back(other);
            }
    return pairs;
}

std::string seconds_text(double seconds) {
    if (!std::isfinite(seconds)) return "?";
    if (seconds < 120) return fmt::format("{:.3g} s", seconds);
    if (seconds < 7200) return fmt::format("{:.3g} min", seconds / 60);
    return seconds < 360'000 ? fmt::format("{:.3g} h", seconds / 3600) : fmt::format("{:.3g} d", seconds / 86400);
}

std::string percent(double share) {
    return fmt::format("{:.3g} %", 100 * share);
}

/// Both ends beyond 1 on opposite sides: the choice of measure decides who wins.
bool contradict(const Interval& a, const Interval& b) {
    return (a.low > 1 && b.high < 1) || (a.high < 1 && b.low > 1);
}

}  // namespace

std::string interval_text(const Interval& interval) {
    if (!std::isfinite(interval.mean)) return "?";
    std::string text = fmt::format("{:.3g}", interval.mean);
    if (std::isfinite(interval.low)) text += fmt::format(" [{:.3g}, {:.3g}]", interval.low, interval.high);
    return text;
}

Interval gain_over_baseline(const StudyResults& results, const SceneResult& scene, const MethodResult& method,
                            const Measure& measure) {
    const auto [base, own] = paired(results.of(scene.name, results.baseline), results.of(scene.name, method.name));
    const auto cost = [&](const CellResult& cell) {
        const PassRow& last = cell.passes.back();
        return measure.value(last) * measure.value(last) * last.run_seconds;
    };
    return geometric_ratio(values(base, cost), values(own, cost));
}

std::string final_table(const StudyResults& results, const SceneResult& scene) {
    std::vector<std::vector<std::string>> rows = {{"method", "seeds", "spp", "seconds", "core-seconds", "RMSE / mean",
                                                   "root of relMSE", "trimmed", "MAPE", "FLIP", "outliers",
                                                   "gain by relMSE", "gain, trimmed"}};
    bool doubtful = false;
    for (const MethodResult& method : results.methods) {
        const Cells cells = results.of(scene.name, method.name);
        if (cells.empty()) continue;
        const auto last = [](auto get) { return [get](const CellResult& cell) { return get(cell.passes.back()); }; };
        const auto figure = [&](const char* key) {
            return mean(cells, last([key](const PassRow& row) { return row.measured.at(key); }));
        };
        const auto error = [&](const Measure& measure) {
            return percent(geometric_mean(values(cells, last(measure.value))).mean);
        };
        const Interval gain = gain_over_baseline(results, scene, method, measures()[1]);
        const Interval trimmed = gain_over_baseline(results, scene, method, measures()[2]);
        doubtful = doubtful || contradict(gain, trimmed);
        rows.push_back({html_text(method.name), std::to_string(cells.size()),
                        fmt::format("{:.4g}", mean(cells, last([](const PassRow& r) { return double(r.spp_done); }))),
                        fmt::format("{:.3g}", mean(cells, last([](const PassRow& r) { return r.run_seconds; }))),
                        fmt::format("{:.3g}", mean(cells, last([](const PassRow& r) { return r.core_seconds; }))),
                        error(measures()[0]), error(measures()[1]), error(measures()[2]), percent(figure("mape")),
                        fmt::format("{:.3g}", mean(cells, [](const CellResult& cell) { return cell.flip; })),
                        fmt::format("{:.3g}", figure("outliers")), interval_text(gain), interval_text(trimmed)});
    }
    std::string html = html_table(rows);
    if (doubtful)
        html +=
            "<p class=\"warning\">By trimmed and by untrimmed error different methods win: claim neither alone.</p>\n";
    return html;
}

std::string time_table(const StudyResults& results, const SceneResult& scene, const Measure& measure) {
    std::vector<std::vector<std::string>> rows = {{"method"}};
    for (const double target : kTargets)
        rows[0].push_back("time to " + percent(target));
    for (const MethodResult& method : results.methods) {
        const auto [base, own] = paired(results.of(scene.name, results.baseline), results.of(scene.name, method.name));
        if (own.empty()) continue;
        std::vector<std::string> row = {html_text(method.name)};
        for (const double target : kTargets) {
            bool beyond = false;
            const auto time = [&](const CellResult& cell) {
                const Crossing at = time_to(curve_of(cell, measure), target);
                beyond = beyond || at.extrapolated;
                return at.seconds;
            };
            const std::vector<double> a = values(base, time), b = values(own, time);
            const Interval seconds = geometric_mean(b);
            std::string text = (beyond ? "~" : "") + seconds_text(seconds.mean);
            if (std::isfinite(seconds.low))
                text += " [" + seconds_text(seconds.low) + ", " + seconds_text(seconds.high) + "]";
            text += "<br>&times;" + interval_text(geometric_ratio(a, b));
            row.push_back(beyond ? "<span class=\"beyond\">" + text + "</span>" : text);
        }
        rows.push_back(row);
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
                with.empty() ? "" : percent(figure([](const PassRow& row) { return row.nonzero_share; })));
            rows[pass + 1].push_back(with.empty() ? "" : fmt::format("{:.3g}", 1e-6 * figure([](const PassRow& row) {
                                                                                   return row.tree_memory;
                                                                               })));
        }
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
