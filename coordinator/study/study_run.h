// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <ostream>

#include "common/config/study.h"
#include "coordinator/render_run.h"

namespace treefarm {

struct StudyOutcome {
    RunState state = RunState::failed;
    std::set<int> lost_peers;
};

/// How a study was started, and where it speaks.
struct StudyContext {
    std::string command;  ///< as it was typed
    Fingerprint build;    ///< of this program
    ConsolePtr console;
    Loudness loudness = Loudness::normal;
    bool overwrite = false;  ///< the other study that its folder holds
    Log log;                 ///< on that console
};

/// Runs a study's cells that are not there yet, in one allocation of workers, and leaves in its folder:
///   study.json                    what is compared, and the cells' folders in order
///   references/NAME/image.exr     those that were rendered
///   cells/NAME/                   a run directory each, with cell.json: written last, so a cell with one is whole
/// A folder's name holds a hash of all that decides its content, so a changed study finds what still holds.
StudyOutcome run_study(Channel& channel, const Study& study, const StudyContext& context,
                       const std::function<bool()>& interrupted);

/// Lists the cells in the order in which they would run, and which of them are there.
void list_cells(const Study& study, const Fingerprint& build, std::ostream& out);

}  // namespace treefarm
