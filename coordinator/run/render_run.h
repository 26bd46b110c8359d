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
#include "common/plan/effects/effects.h"
#include "common/protocol/fingerprint.h"
#include "common/scene/model/scene.h"
#include "coordinator/run/run_directory.h"
#include "coordinator/run/sign_of_life.h"
#include "coordinator/words/progress.h"

namespace treefarm {

/// Request of a render, with all input read and checked.
struct RenderRequest {
    Job job;
    Scene scene;                                ///< without the effects that the job forces off
    EffectPlan plan;                            ///< of scene and job
    std::vector<std::string> warnings;          ///< of the readers, for the log
    std::vector<std::string> notes;             ///< of the readers, other than faults
    std::vector<PassPlan> schedule;             ///< --schedule: these passes; empty: the job's own
    std::string command;                        ///< as it was typed
    std::string debug_command;                  ///< reproduces a sample with " pass,x,y,sample" and --schedule appended
    Fingerprint fingerprint;                    ///< of this process
    std::shared_ptr<SignOfLife> life;           ///< heartbeat for a supervisor; nullptr: none
    std::string display_server;                 ///< HOST:PORT of a viewer with tev's protocol; "": none
    bool overwrite = false;                     ///< an earlier run in the folder may be replaced
    bool checkpoints = true;                    ///< whether checkpoints are written; false in a series of short renders
    std::optional<AnyModel> initial_model;      ///< guides the first pass; no value: the guide's initial model
    std::shared_ptr<LoadedCheckpoint> resumed;  ///< checkpoint being resumed; its state is moved out
    ConsolePtr console = std::make_shared<Console>(TerminalKind{}, false);
    Loudness loudness = Loudness::normal;  ///< of the log on the console
    StatusFrame status_frame;              ///< form of the console's progress line; empty: as render_status()
    JobTurn turn;                          ///< among the jobs of a study
    /// Called after each pass, with the image so far; its time counts as rendering. May be empty.
    std::function<void(const PassReport&, const CombinedImage&)> on_pass;
};

/// Initial state of a request that resumes nothing.
RenderState starting_state(const RenderRequest& request);

/// Pass planner of a request.
PassChooser passes_of(const RenderRequest& request);

struct RenderOutcome {
    RunState state = RunState::failed;
    bool missed_target = false;  ///< done, but the error is above budget.error
    std::set<int> left_peers;    ///< workers that left in order
    std::set<int> lost_peers;    ///< workers lost in this job or an earlier one that are not back
};

/// Runs a render to its end on the coordinator's side of `channel`: run directory, workers, passes, files. Errors after
/// the run directory exists are logged and summarised there. Workers are not dismissed: the caller does that.
RenderOutcome run_render(Channel& channel, const RenderRequest& request, const std::function<bool()>& interrupted);

}  // namespace treefarm
