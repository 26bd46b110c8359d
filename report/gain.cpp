// SPDX-License-Identifier: Apache-2.0
#include "report/gain.h"

#include <cmath>
#include <map>

namespace treefarm {

std::pair<Cells, Cells> paired(const Cells& a, const Cells& b) {
    std::pair<Cells, Cells> pairs;
    for (const CellResult* one : a)
        for (const CellResult* other : b)
            if (one->repetition == other->repetition && one->budget == other->budget) {
                pairs.first.push_back(one);
                pairs.second.push_back(other);
            }
    return pairs;
}

Interval gain(const StudyResults& results, std::span<const SceneResult> scenes, const std::string& own,
              const std::string& base, const Measure& measure, const Clock& clock) {
    const auto log_cost = [&](const CellResult& cell) {
        const PassRow& last = cell.passes.back();
        return 2 * std::log(measure.value(last)) + std::log(clock.value(last));
    };
    std::map<std::size_t, std::vector<double>> logarithms;  // per repetition: a value per scene
    std::size_t compared = 0;
    for (const SceneResult& scene : scenes) {
        const auto [with, without] = paired(results.of(scene.name, own), results.of(scene.name, base));
        compared += !with.empty();
        for (std::size_t k = 0; k < with.size(); ++k)
            logarithms[with[k]->repetition].push_back(log_cost(*without[k]) - log_cost(*with[k]));
    }
    std::vector<double> ratios;
    for (const auto& [repetition, values] : logarithms) {
        if (values.size() != compared) continue;  // a seed that only some scenes have
        double sum = 0;
        for (const double value : values)
            sum += value;
        ratios.push_back(std::exp(sum / static_cast<double>(compared)));
    }
    return geometric_mean(ratios);
}

}  // namespace treefarm
