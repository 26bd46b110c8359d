// SPDX-License-Identifier: Apache-2.0
#include "report/figure_export.h"

#include <cmath>
#include <cstdlib>

#include "common/base/error.h"
#include "report/study_charts.h"

namespace treefarm {

double figure_width(const std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    std::string unit = end;
    std::erase(unit, ' ');
    const double inches = unit == "in" || unit.empty() ? value
                          : unit == "cm"               ? value / 2.54
                          : unit == "mm"               ? value / 25.4
                                                       : NAN;
    if (end == text.c_str() || !(inches >= 1 && inches <= 40))
        throw InputError(Location{"--width"}, "\"" + text + "\" is no width of a figure",
                         "give inches, cm or mm, from 1 to 40 inches: 3.3in, 84mm");
    return inches;
}

ExportedFigures export_figures(const StudyResults& results, const FigureStyle& style,
                               const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    ExportedFigures exported;
    const auto write = [&](const Picture& picture) {
        if (picture.script.empty()) return;
        exported.with_pdf = write_figure(picture, style, folder) && exported.with_pdf;
        ++exported.figures;
    };
    for (const std::string& budget : results.budgets) {
        const StudyResults part = results.of_budget(budget);
        for (const SceneResult& scene : part.scenes) {
            for (const Measure& measure : part.measured_by)
                for (const Clock& clock : clocks())
                    write(convergence_chart(part, scene, measure, clock));
            if (!part.has_references) continue;
            write(estimate_chart(part, scene));
            write(forecast_chart(part, scene));
        }
    }
    return exported;
}

}  // namespace treefarm
