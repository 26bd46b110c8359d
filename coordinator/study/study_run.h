// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <ostream>

#include "coordinator/run/render_series.h"
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
StudyOutcome run_study(Channel& channel, const Study& study, const SeriesContext& context,
                       const std::function<bool()>& interrupted);

/// Prints the cells in their order of rendering, and which of them exist.
void list_cells(const Study& study, const Fingerprint& build, std::ostream& out);

}  // namespace treefarm
