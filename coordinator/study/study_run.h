// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coordinator/render/render_series.h"
#include "coordinator/study/study.h"

namespace treefarm {

struct StudyOutcome {
    RunState state = RunState::failed;
    std::set<int> lost_peers;
};

/// Renders a study's missing cells within one allocation of workers, and writes to its folder:
///   study.json                    the compared methods and scenes, and the cells' folders in order
///   references/NAME/image.exr     rendered references
///   cells/NAME/                   run directory of a cell, with cell.json: written last, as a mark of completeness
/// A folder's name contains a hash of all that decides its content, so that a changed study reuses the valid cells.
StudyOutcome run_study(const Study& study, const SeriesContext& context);

}  // namespace treefarm
