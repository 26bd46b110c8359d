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

/// Runs a study's cells that are not there yet, in one allocation of workers, and leaves in its folder:
///   study.json                    what is compared, and the cells' folders in order
///   references/NAME/image.exr     those that were rendered
///   cells/NAME/                   a run directory each, with cell.json: written last, so a cell with one is whole
/// A folder's name holds a hash of all that decides its content, so a changed study finds what still holds.
StudyOutcome run_study(Channel& channel, const Study& study, const SeriesContext& context,
                       const std::function<bool()>& interrupted);

/// Lists the cells in the order in which they would run, and which of them are there.
void list_cells(const Study& study, const Fingerprint& build, std::ostream& out);

}  // namespace treefarm
