// SPDX-License-Identifier: Apache-2.0
#include "report/processor_fraction.h"

#include <spdlog/fmt/fmt.h>

#include <limits>

namespace treefarm {

double processor_fraction(const CellResult& cell) {
    double offered = 0;
    for (const PassRow& row : cell.passes)
        if (const auto collect = row.phases.find("collect"); collect != row.phases.end())
            offered += collect->second * row.threads;
    if (!(offered > 0)) return std::numeric_limits<double>::quiet_NaN();
    return cell.passes.back().core_seconds / offered;
}

bool was_busy(const StudyResults& results) {
    return !busy_warning(results).empty();
}

std::string busy_warning(const StudyResults& results) {
    const CellResult* least = nullptr;
    std::size_t busy = 0;
    for (const CellResult& cell : results.cells) {
        const double fraction = processor_fraction(cell);
        if (!(fraction < kLeastProcessorFraction)) continue;
        ++busy;
        if (least == nullptr || fraction < processor_fraction(*least)) least = &cell;
    }
    if (least == nullptr) return "";
    return fmt::format(
        "Beside a busy processor: in {} of {} renders workers had less than {:.0f} % of their processors (least: "
        "{:.0f} %, {}, {}, seed {}). Seconds are not the methods' own then: compare core-seconds, or render again on "
        "a machine that does nothing else, with no more threads than cores.",
        busy, results.cells.size(), 100 * kLeastProcessorFraction, 100 * processor_fraction(*least), least->scene,
        least->method, least->seed);
}

}  // namespace treefarm
