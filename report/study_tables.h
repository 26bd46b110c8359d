#pragma once

#include <string>

#include "report/study_results.h"

namespace treefarm {

// Tables of a scene's cells, as HTML. Intervals are 95 %, of geometric means over the seeds.

/// How many times as efficient as the baseline a method is: ratio of (error^2 x seconds) at the end, by seeds in pairs.
Interval gain_over_baseline(const StudyResults& results, const SceneResult& scene, const MethodResult& method,
                            const Measure& measure);

/// What came out at the end of the budget, and the gain over the baseline by untrimmed and trimmed error.
std::string final_table(const StudyResults& results, const SceneResult& scene);

/// Seconds to 10, 5, 2, 1 and 0.5 %, and how many times as fast as the baseline.
std::string time_table(const StudyResults& results, const SceneResult& scene, const Measure& measure);

/// Nonzero-path share and memory of the tree by pass: the form of the thesis' tables 3.1 to 3.4.
std::string pass_table(const StudyResults& results, const SceneResult& scene);

/// Thread-seconds of each worker, busy and idle.
std::string worker_table(const StudyResults& results, const SceneResult& scene);

/// "1.23 [1.1, 1.4]", three digits.
std::string interval_text(const Interval& interval);

}  // namespace treefarm
