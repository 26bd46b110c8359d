// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "report/gnuplot.h"
#include "report/study_results.h"

namespace treefarm {

// Pictures of a scene's cells, of one budget. Without a script where there is nothing to draw.

/// Error over time of rendering, log-log: mean and 95 % interval over the seeds, the passes as points, a guide of
/// slope -1/2.
Picture convergence_chart(const StudyResults& results, const SceneResult& scene, const Measure& measure,
                          const Clock& clock);

/// The error that renders claimed against the one that was measured, every pass of every cell.
Picture estimate_chart(const StudyResults& results, const SceneResult& scene);

/// When half of a pass's error was forecast to be reached, against when it was.
Picture forecast_chart(const StudyResults& results, const SceneResult& scene);

}  // namespace treefarm
