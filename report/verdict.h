// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "report/study_results.h"

namespace treefarm {

/// Who won at the end of a budget, by how much, and whether chance can have made it. `results` are of one budget;
/// several scenes are judged together.
std::string verdict(const StudyResults& results, std::span<const SceneResult> scenes, const Clock& clock);

/// Price of 5 % error to the winner and the baseline, or how far they came.
std::string price_of_five_percent(const StudyResults& results, const SceneResult& scene, const Clock& clock);

/// The study's answer, a line per scene and budget, and one over all scenes where there are several.
std::vector<std::string> answers(const StudyResults& results, const Clock& clock);

/// The clock to read first: core-seconds where the processors were busy with something else.
const Clock& main_clock(const StudyResults& results);

}  // namespace treefarm
