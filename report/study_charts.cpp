#include "report/study_charts.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "report/gnuplot.h"

namespace treefarm {

namespace {

/// Okabe and Ito's colours (2008), which the colour-blind tell apart.
constexpr const char* kColours[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"};
constexpr int kGridPoints = 25;

const char* colour(std::size_t k) {
    return kColours[k % std::size(kColours)];
}

/// A block of data lines under a name.
std::string block(const std::string& name, const std::string& lines) {
    return "$" + name + " << EOD\n" + lines + "EOD\n";
}

/// Mean and interval over the seeds, at times that all of them cover.
std::string band(const std::vector<std::vector<CurvePoint>>& curves) {
    double first = 0, last = INFINITY;
    for (const auto& curve : curves) {
        if (curve.empty()) return "";
        first = std::max(first, curve.front().seconds);
        last = std::min(last, curve.back().seconds);
    }
    if (!(last > first)) return "";
    std::string lines;
    for (int k = 0; k < kGridPoints; ++k) {
        const double seconds = first * std::pow(last / first, k / (kGridPoints - 1.0));
        std::vector<double> errors;
        for (const auto& curve : curves)
            errors.push_back(error_at(curve, seconds));
        const Interval at = geometric_mean(errors);
        const bool spread = std::isfinite(at.low);
        lines += fmt::format("{} {} {} {}\n", seconds, at.mean, spread ? at.low : at.mean, spread ? at.high : at.mean);
    }
    return lines;
}

std::string file_name(const std::string& kind, const SceneResult& scene) {
    std::string name = kind;
    for (const char c : scene.name)
        name += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
    return name;
}

const std::string kLogAxes =
    "set logscale xy\nset format x '%g'\nset format y '%g %%'\nset grid xtics ytics lc rgb '#dddddd'\nset key "
    "noenhanced\n";

/// Points of all methods under logarithmic axes with the diagonal on which both would agree.
std::string agreement_chart(const StudyResults& results, const std::vector<std::string>& lines, const std::string& axes,
                            const std::string& name) {
    std::string data, plots;
    for (std::size_t m = 0; m < lines.size(); ++m) {
        if (lines[m].empty()) continue;
        data += block("m" + std::to_string(m), lines[m]);
        plots += fmt::format(", $m{} using 1:2 with points pt 7 ps 0.5 lc rgb '{}' title {}", m, colour(m),
                             gnuplot_quoted(results.methods[m].name));
    }
    if (data.empty()) return "";
    return draw_svg(kLogAxes + data + axes +
                        "set key top left\nset size square\nplot x with lines lc rgb '#999999' dt 2 title 'agreement'" +
                        plots,
                    name, 460, 420);
}

}  // namespace

std::string convergence_chart(const StudyResults& results, const SceneResult& scene, const Measure& measure) {
    std::string data, bands, lines;
    double first = INFINITY, last = 0, top = 0;
    for (std::size_t m = 0; m < results.methods.size(); ++m) {
        std::vector<std::vector<CurvePoint>> curves;
        std::string points;
        for (const CellResult* cell : results.of(scene.name, results.methods[m].name)) {
            curves.push_back(curve_of(*cell, measure));
            for (const CurvePoint& point : curves.back()) {
                points += fmt::format("{} {}\n", point.seconds, point.error);
                first = std::min(first, point.seconds);
                last = std::max(last, point.seconds);
                top = std::max(top, point.error);
            }
        }
        if (points.empty()) continue;
        data += block(fmt::format("points{}", m), points);
        lines += fmt::format(", $points{} using 1:(100*$2) with points pt 7 ps 0.35 lc rgb '{}' {}", m, colour(m),
                             "notitle");
        const std::string mean = band(curves);
        if (mean.empty()) {
            lines += fmt::format(", NaN with lines lc rgb '{}' title {}", colour(m),
                                 gnuplot_quoted(results.methods[m].name));
            continue;
        }
        data += block(fmt::format("band{}", m), mean);
        bands += fmt::format(
            "$band{0} using 1:(100*$3):(100*$4) with filledcurves fc rgb '{1}' fs transparent solid 0.15 noborder "
            "notitle, ",
            m, colour(m));
        lines += fmt::format(", $band{} using 1:(100*$2) with lines lw 2 lc rgb '{}' title {}", m, colour(m),
                             gnuplot_quoted(results.methods[m].name));
    }
    if (data.empty()) return "";
    const std::string guide = fmt::format("[{}:{}] {}*x**-0.5 with lines dt 2 lc rgb '#888888' title 'slope -1/2'",
                                          first, last, 100 * top * std::sqrt(first));
    return draw_svg(
        kLogAxes + data +
            fmt::format("set xlabel 'seconds of rendering'\nset ylabel {}\nset key outside right\nplot {}{}{}",
                        gnuplot_quoted(measure.name), bands, guide, lines),
        file_name(measure.key, scene), 860, 420);
}

std::string estimate_chart(const StudyResults& results, const SceneResult& scene) {
    std::vector<std::string> lines(results.methods.size());
    for (std::size_t m = 0; m < results.methods.size(); ++m)
        for (const CellResult* cell : results.of(scene.name, results.methods[m].name))
            for (const PassRow& row : cell->passes)
                if (row.estimate > 0)
                    lines[m] += fmt::format("{} {}\n", 100 * row.estimate, 100 * row.measured.at("rmse_over_mean"));
    return agreement_chart(
        results, lines, "set format x '%g %%'\nset xlabel 'estimated RMSE / mean'\nset ylabel 'measured RMSE / mean'\n",
        file_name("estimate", scene));
}

std::string forecast_chart(const StudyResults& results, const SceneResult& scene) {
    std::vector<std::string> lines(results.methods.size());
    const Measure& measure = measures().front();
    for (std::size_t m = 0; m < results.methods.size(); ++m)
        for (const CellResult* cell : results.of(scene.name, results.methods[m].name)) {
            const std::vector<CurvePoint> curve = curve_of(*cell, measure);
            for (const PassRow& row : cell->passes) {
                const Crossing actual = time_to(curve, 0.5 * measure.value(row));
                const bool trusted = row.halving.trust == "firm" || row.halving.trust == "noisy";
                if (trusted && std::isfinite(row.halving.seconds) && !actual.extrapolated)
                    lines[m] += fmt::format("{} {}\n", row.run_seconds + row.halving.seconds, actual.seconds);
            }
        }
    return agreement_chart(results, lines,
                           "set format y '%g'\nset xlabel 'forecast: half the error at [s]'\nset ylabel 'measured: "
                           "half the error at [s]'\n",
                           file_name("forecast", scene));
}

std::string phase_chart(const StudyResults& results, const SceneResult& scene) {
    constexpr const char* phases[] = {"broadcast", "collect", "refine", "film", "error"};
    std::string lines = "method";
    for (const char* phase : phases)
        lines += std::string(" ") + phase;
    lines += '\n';
    for (const MethodResult& method : results.methods) {
        const auto cells = results.of(scene.name, method.name);
        if (cells.empty()) continue;
        lines += gnuplot_quoted(method.name);
        for (const char* phase : phases) {
            double sum = 0;
            for (const CellResult* cell : cells)
                for (const PassRow& row : cell->passes)
                    sum += row.phases.at(phase);
            lines += fmt::format(" {}", sum / static_cast<double>(cells.size()));
        }
        lines += '\n';
    }
    std::string plot;
    for (std::size_t k = 0; k < std::size(phases); ++k)
        plot += fmt::format("{}$phases using {}{} title '{}' lc rgb '{}'", k ? ", " : "plot ", k + 2,
                            k == 0 ? ":xtic(1)" : "", phases[k], colour(k));
    return draw_svg(
        block("phases", lines) +
            "set style data histograms\nset style histogram rowstacked\nset style fill solid 0.8\nset boxwidth 0.7\n"
            "set yrange [0:*]\nset ylabel 'seconds'\nset xtics rotate by -20 noenhanced\nset key outside right\n" +
            plot,
        file_name("phases", scene), 860, 320);
}

}  // namespace treefarm
