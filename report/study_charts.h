#pragma once

#include <string>

#include "report/study_results.h"

namespace treefarm {

// SVG pictures of a scene's cells.

/// Error over seconds of rendering, log-log: mean and 95 % interval over the seeds, the passes as points, a guide of
/// slope -1/2.
std::string convergence_chart(const StudyResults& results, const SceneResult& scene, const Measure& measure);

/// The error that renders claimed against the one that was measured, every pass of every cell.
std::string estimate_chart(const StudyResults& results, const SceneResult& scene);

/// When half of a pass's error was forecast to be reached, against when it was.
std::string forecast_chart(const StudyResults& results, const SceneResult& scene);

/// Where the seconds went, phase by phase.
std::string phase_chart(const StudyResults& results, const SceneResult& scene);

}  // namespace treefarm
