// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "report/study_results.h"

namespace treefarm {

/// Winner at the end of a budget, with its margin and significance. `results` are of one budget; several scenes are
/// judged together.
std::string verdict(const StudyResults& results, std::span<const SceneResult> scenes, const Clock& clock);

/// Price of 5 % error for the winner and the baseline, or the errors that they reached.
std::string price_of_five_percent(const StudyResults& results, const SceneResult& scene, const Clock& clock);

/// Summary of the study: a line per scene and budget, and one over all scenes if there are several.
std::vector<std::string> answers(const StudyResults& results, const Clock& clock);

/// Clock to be read first: core-seconds if the processors were busy with other programs.
const Clock& main_clock(const StudyResults& results);

}  // namespace treefarm
