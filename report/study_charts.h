// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "report/gnuplot.h"
#include "report/study_results.h"

namespace treefarm {

// Pictures of a scene's cells, of one budget. The script is empty if there is nothing to draw.

/// Error over time of rendering, log-log: mean and 95 % interval over the seeds, the passes as points, a reference line
/// of slope -1/2.
Picture convergence_chart(const StudyResults& results, const SceneResult& scene, const Measure& measure,
                          const Clock& clock);

/// Estimated error of renders against the measured one, every pass of every cell.
Picture estimate_chart(const StudyResults& results, const SceneResult& scene);

/// Forecast of the time to half a pass's error, against the actual time.
Picture forecast_chart(const StudyResults& results, const SceneResult& scene);

}  // namespace treefarm
