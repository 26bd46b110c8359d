// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "report/study_results.h"

namespace treefarm {

// Tables of a scene's cells, as HTML, of one budget. Intervals are 95 %, of geometric means over the seeds.

/// Error at the end of the budget by the first measure, and how many times as fast as the baseline each method is; a
/// warning if another measure contradicts.
std::string headline_table(const StudyResults& results, const SceneResult& scene, const Clock& clock);

/// Errors and gains by the other measures; "" if there is none.
std::string other_measures_table(const StudyResults& results, const SceneResult& scene, const Clock& clock);

/// Other figures at the end of the budget: seconds, core-seconds, fraction of the processors, other errors.
std::string figures_table(const StudyResults& results, const SceneResult& scene);

/// Time to 10, 5, 2, 1 and 0.5 % error, with the speed-up over the baseline.
std::string time_table(const StudyResults& results, const SceneResult& scene, const Measure& measure,
                       const Clock& clock);

/// Error and gain at the end of each budget, for a study with several.
std::string budget_table(const StudyResults& results, const SceneResult& scene, const Clock& clock);

/// Fraction of nonzero paths and memory of the tree by pass, in the form of the thesis' tables 3.1 to 3.4.
std::string pass_table(const StudyResults& results, const SceneResult& scene);

/// Seconds of the coordinator's clock by phase.
std::string phase_table(const StudyResults& results, const SceneResult& scene);

/// Thread-seconds of each worker, busy and idle.
std::string worker_table(const StudyResults& results, const SceneResult& scene);

}  // namespace treefarm
