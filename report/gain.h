// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "report/study_results.h"

namespace treefarm {

using Cells = std::vector<const CellResult*>;

/// Cells of both methods with equal seeds.
std::pair<Cells, Cells> paired(const Cells& a, const Cells& b);

/// Speed-up of `own` over `base` at equal error: ratio of error^2 x time at the end of the budget, by pairs of seeds.
/// Over several scenes: of each seed's geometric mean over them. `results` are of one budget.
Interval gain(const StudyResults& results, std::span<const SceneResult> scenes, const std::string& own,
              const std::string& base, const Measure& measure, const Clock& clock);

}  // namespace treefarm
