// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/comm/channel.h"
#include "common/config/job.h"
#include "common/plan/effects.h"
#include "common/protocol/fingerprint.h"
#include "common/scene/model/scene.h"
#include "coordinator/launch/sign_of_life.h"
#include "coordinator/progress.h"
#include "coordinator/run_directory.h"

namespace treefarm {

/// A render as it was asked for: everything read and checked.
struct RenderRequest {
    Job job;
    Scene scene;                            ///< without the effects that the job forces off
    EffectPlan plan;                        ///< of both
    std::vector<std::string> warnings;      ///< of the readers, for the log
    std::vector<std::string> notes;         ///< of the readers, of what is no fault
    std::vector<PassPlan> schedule;         ///< --schedule: these passes; empty: the job's own
    std::string command;                    ///< as it was typed
    std::string debug_command;              ///< reproduces a sample with " pass,x,y,sample" and --schedule appended
    Fingerprint fingerprint;                ///< of this process
    std::shared_ptr<SignOfLife> life;       ///< that a supervisor watches; nullptr: none does
    std::string display_server;             ///< HOST:PORT of a viewer that speaks tev's protocol; "": none
    bool overwrite = false;                 ///< an earlier run in the folder may be replaced
    bool checkpoints = true;                ///< the render can be gone on with; false: it is one of many that are short
    std::optional<AnyModel> initial_model;  ///< that guides the first pass; nothing: the guide's first
    std::shared_ptr<LoadedCheckpoint> resumed;  ///< what the render goes on from; its state is taken
    ConsolePtr console = std::make_shared<Console>(TerminalKind{}, false);
    Verbosity verbosity = Verbosity::normal;  ///< of the log on the console
    StatusFrame status_frame;                 ///< how the console says how far it is; empty: as render_status does
    JobTurn turn;                             ///< among the jobs of a study
    /// Called after each pass, with the image so far; what it takes counts as the render's time. May be empty.
    std::function<void(const PassReport&, const CombinedImage&)> on_pass;
};

/// The state that it begins with where it goes on from none.
RenderState starting_state(const RenderRequest& request);

/// The passes that it asks for.
PassChooser passes_of(const RenderRequest& request);

struct RenderOutcome {
    RunState state = RunState::failed;
    bool missed_target = false;  ///< done, but the error is above budget.error
    std::set<int> left_peers;    ///< workers that left in order
    std::set<int> lost_peers;    ///< workers that were given up, now or in an earlier job, and are not back
};

/// Runs a render to its end on the coordinator's side of `channel`: run directory, workers, passes, files. What goes
/// wrong after the run directory exists is logged and summarised there. Workers are not dismissed: the caller does
/// that.
RenderOutcome run_render(Channel& channel, const RenderRequest& request, const std::function<bool()>& interrupted);

}  // namespace treefarm
