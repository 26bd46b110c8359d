// SPDX-License-Identifier: Apache-2.0
#include "report/study_charts.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "report/figure_text.h"
#include "report/gain.h"

namespace treefarm {

namespace {

/// Colours of Okabe and Ito (2008), distinguishable by colour-blind readers.
constexpr const char* kColours[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"};
constexpr int kGridPoints = 25;
constexpr int kPlotHeight = 340, kLegendLine = 18, kLetterWidth = 8, kKeyWidth = 60;

const char* colour(std::size_t k) {
    return kColours[k % std::size(kColours)];
}

/// A named block of data lines.
std::string block(const std::string& name, const std::string& lines) {
    return "$" + name + " << EOD\n" + lines + "EOD\n";
}

std::string csv_quoted(const std::string& text) {
    return text.find_first_of(",\"") == std::string::npos ? text : '"' + text + '"';
}

/// Range of an axis.
struct Range {
    double low = INFINITY, high = 0;
    void include(double value) {
        low = std::min(low, value);
        high = std::max(high, value);
    }
};

/// Logarithmic axis slightly longer than its range, with enough tick marks: 1, 2, 5 if it spans few decades. `unit` is
/// a format: %% for a percent sign.
std::string log_axis(const char* axis, const Range& range, const char* unit) {
    const double low = range.low / 1.25, high = range.high * 1.25;
    const bool is_long = high / low > 1000;
    std::string marks;
    for (int decade = static_cast<int>(std::floor(std::log10(low))); std::pow(10, decade) <= high; ++decade)
        for (const int digit : {1, 2, 5}) {
            const double at = digit * std::pow(10, decade);
            if (at < low || at > high || (is_long && digit > 1)) continue;
            marks += fmt::format("{}'{:g}{}' {:g}", marks.empty() ? "" : ", ", at, unit, at);
        }
    return fmt::format("set {0}range [{1:g}:{2:g}]\nset {0}tics ({3})\n", axis, low, high, marks);
}

/// Mean and interval over the seeds, at times covered by all of them; without an interval for too few seeds.
std::vector<std::pair<double, Interval>> band(const std::vector<std::vector<CurvePoint>>& curves) {
    double first = 0, last = INFINITY;
    for (const auto& curve : curves) {
        if (curve.empty()) return {};
        first = std::max(first, curve.front().seconds);
        last = std::min(last, curve.back().seconds);
    }
    if (!(last > first)) return {};
    std::vector<std::pair<double, Interval>> points;
    for (int k = 0; k < kGridPoints; ++k) {
        const double seconds = first * std::pow(last / first, k / (kGridPoints - 1.0));
        std::vector<double> errors;
        errors.reserve(curves.size());
        for (const auto& curve : curves)
            errors.push_back(error_at(curve, seconds));
        Interval at = geometric_mean(errors);
        if (at.values < kLeastSeeds) at.low = at.high = at.mean;
        points.emplace_back(seconds, at);
    }
    return points;
}

std::string file_name(const std::string& kind, const StudyResults& results, const SceneResult& scene) {
    std::string name = scene.name + "_" + kind;
    if (results.budgets.size() == 1 && !results.cells.empty()) name += "_" + results.budgets.front();
    for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
    return name;
}

/// Adds a legend below the picture, and its height.
void add_legend(Picture& picture, const StudyResults& results, std::size_t more) {
    std::size_t longest = 10;
    for (const MethodResult& method : results.methods)
        longest = std::max(longest, method.name.size());
    const int columns = std::max(1, picture.width / (kLetterWidth * static_cast<int>(longest) + kKeyWidth));
    const int lines = (static_cast<int>(results.methods.size() + more) + columns - 1) / columns;
    picture.height = kPlotHeight + kLegendLine * lines;
    picture.script += "set key below center horizontal noenhanced\n";
}

const std::string kLogAxes = "set logscale xy\nset grid xtics ytics lc rgb '#dddddd'\n";

/// Parts of one method in a picture of errors over time.
struct MethodCurves {
    std::string points, band, csv;
};

MethodCurves method_curves(const Cells& cells, const std::string& method, const Measure& measure, const Clock& clock,
                           Range& times, Range& errors) {
    MethodCurves of;
    std::vector<std::vector<CurvePoint>> curves;
    for (const CellResult* cell : cells) {
        curves.push_back(curve_of(*cell, measure, clock));
        for (const CurvePoint& point : curves.back()) {
            of.points += fmt::format("{} {}\n", point.seconds, 100 * point.error);
            of.csv += fmt::format("pass,{},{},{},{},,\n", csv_quoted(method), cell->seed, point.seconds, point.error);
            times.include(point.seconds);
            errors.include(100 * point.error);
        }
    }
    for (const auto& [seconds, at] : band(curves)) {
        of.band += fmt::format("{} {} {} {}\n", seconds, 100 * at.mean, 100 * at.low, 100 * at.high);
        of.csv += fmt::format("mean,{},,{},{},{},{}\n", csv_quoted(method), seconds, at.mean, at.low, at.high);
    }
    return of;
}

/// Points of all methods on logarithmic axes, with the diagonal of perfect agreement.
Picture agreement_chart(Picture picture, const StudyResults& results,
                        const std::vector<std::vector<std::pair<double, double>>>& points, const std::string& labels,
                        const char* unit) {
    std::string data, plots;
    Range range;
    for (std::size_t m = 0; m < points.size(); ++m) {
        std::string lines;
        for (const auto& [x, y] : points[m]) {
            lines += fmt::format("{} {}\n", x, y);
            picture.data += fmt::format("{},{},{}\n", csv_quoted(results.methods[m].name), x, y);
            range.include(x);
            range.include(y);
        }
        if (lines.empty()) continue;
        data += block("m" + std::to_string(m), lines);
        plots += fmt::format(", $m{} using 1:2 with points pt 7 ps 0.5 lc rgb '{}' title {}", m, colour(m),
                             gnuplot_quoted(results.methods[m].name));
    }
    if (data.empty()) return picture;
    picture.script = kLogAxes + data + log_axis("x", range, unit) + log_axis("y", range, unit) + labels;
    add_legend(picture, results, 1);
    picture.script += "plot x with lines lc rgb '#999999' dt 2 title 'agreement'" + plots;
    return picture;
}

}  // namespace

Picture convergence_chart(const StudyResults& results, const SceneResult& scene, const Measure& measure,
                          const Clock& clock) {
    Picture picture;
    picture.name = file_name(std::string(measure.key) + "_over_" + clock.key, results, scene);
    picture.title = fmt::format("{}: {} over {}", scene.name, measure.name, clock.name);
    picture.data = "kind,method,seed," + std::string(clock.key) + ",error,low,high\n";
    std::string data, bands, lines, ends;
    Range times, errors;
    for (std::size_t m = 0; m < results.methods.size(); ++m) {
        const std::string& method = results.methods[m].name;
        const Cells cells = results.of(scene.name, method);
        const MethodCurves of = method_curves(cells, method, measure, clock, times, errors);
        if (of.points.empty()) continue;
        std::vector<double> last;
        for (const CellResult* cell : cells)
            last.push_back(measure.value(cell->passes.back()));
        ends += fmt::format("; {} ends at {}", method, percent_text(geometric_mean(last).mean));
        picture.data += of.csv;
        data += block(fmt::format("points{}", m), of.points);
        lines += fmt::format(", $points{} using 1:2 with points pt 7 ps 0.35 lc rgb '{}' notitle", m, colour(m));
        const std::string title = gnuplot_quoted(method);
        if (of.band.empty()) {
            lines += fmt::format(", NaN with lines lc rgb '{}' title {}", colour(m), title);
            continue;
        }
        data += block(fmt::format("band{}", m), of.band);
        bands += fmt::format(
            "$band{} using 1:3:4 with filledcurves fc rgb '{}' fs transparent solid 0.12 noborder notitle, ", m,
            colour(m));
        lines += fmt::format(", $band{} using 1:2 with lines lw 2 lc rgb '{}' title {}", m, colour(m), title);
    }
    if (data.empty()) return picture;
    picture.description = "A line per method on logarithmic axes" + ends + ".";
    picture.script =
        kLogAxes + data + log_axis("x", times, "") + log_axis("y", errors, " %%") +
        fmt::format("set xlabel '{} of rendering'\nset ylabel {}\n", clock.name, gnuplot_quoted(measure.name));
    add_legend(picture, results, 1);
    picture.script += fmt::format("plot {}[{}:{}] {}*x**-0.5 with lines dt 2 lc rgb '#888888' title 'slope -1/2'{}",
                                  bands, times.low / 1.1, times.high * 1.1, errors.high * std::sqrt(times.low), lines);
    return picture;
}

Picture estimate_chart(const StudyResults& results, const SceneResult& scene) {
    std::vector<std::vector<std::pair<double, double>>> points(results.methods.size());
    for (std::size_t m = 0; m < results.methods.size(); ++m)
        for (const CellResult* cell : results.of(scene.name, results.methods[m].name))
            for (const PassRow& row : cell->passes)
                if (row.estimate > 0)
                    points[m].emplace_back(100 * row.estimate, 100 * row.measured.at("rmse_over_mean"));
    Picture picture;
    picture.name = file_name("estimated_error", results, scene);
    picture.title = scene.name + ": estimated against measured error";
    picture.description = "A point per pass on logarithmic axes; on the diagonal the estimate is right.";
    picture.data = "method,estimated_percent,measured_percent\n";
    return agreement_chart(std::move(picture), results, points,
                           "set xlabel 'estimated RMSE / mean'\nset ylabel 'measured RMSE / mean'\n", " %%");
}

Picture forecast_chart(const StudyResults& results, const SceneResult& scene) {
    std::vector<std::vector<std::pair<double, double>>> points(results.methods.size());
    const Measure& measure = results.measured_by.front();
    for (std::size_t m = 0; m < results.methods.size(); ++m)
        for (const CellResult* cell : results.of(scene.name, results.methods[m].name)) {
            const std::vector<CurvePoint> curve = curve_of(*cell, measure);
            for (const PassRow& row : cell->passes) {
                const Crossing actual = time_to(curve, 0.5 * measure.value(row));
                const bool trusted = row.halving.trust == "firm" || row.halving.trust == "noisy";
                if (trusted && std::isfinite(row.halving.seconds) && !actual.extrapolated)
                    points[m].emplace_back(row.run_seconds + row.halving.seconds, actual.seconds);
            }
        }
    Picture picture;
    picture.name = file_name("forecast_of_half_the_error", results, scene);
    picture.title = scene.name + ": when half the error was forecast, and when it came";
    picture.description = "A point per forecast on logarithmic axes; on the diagonal it is right.";
    picture.data = "method,forecast_seconds,measured_seconds\n";
    return agreement_chart(std::move(picture), results, points,
                           "set xlabel 'half the error: forecast [s]'\nset ylabel 'half the error: measured [s]'\n",
                           "");
}

}  // namespace treefarm
