// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/config/job.h"
#include "common/guiding/any_guide.h"
#include "common/plan/effects/effects.h"
#include "common/plan/forecast/budget.h"
#include "common/protocol/fingerprint.h"
#include "common/scene/model/scene.h"
#include "coordinator/farm/farm.h"
#include "coordinator/render/local_farm.h"
#include "coordinator/run/run_checkpoints.h"

namespace treefarm {

/// Content of a render, with all input read and checked.
struct RenderContent {
    Job job;
    Scene scene;                        ///< without the effects that the job forces off
    EffectPlan plan;                    ///< of scene and job
    std::vector<PassPlan> schedule;     ///< passes to render; empty: those of the job's budget
    std::vector<std::string> warnings;  ///< of the readers, for the log
    std::vector<std::string> notes;     ///< of the readers, other than faults
};

/// Start of a render. Without either member: the guide's initial model, and no samples.
struct RenderStart {
    std::optional<AnyModel> model;                 ///< guides the first pass
    std::shared_ptr<LoadedCheckpoint> checkpoint;  ///< checkpoint being resumed; its state is moved out
};

/// Storage settings of a render, besides job.output (which names the run directory).
struct RenderStorage {
    bool overwrite = false;        ///< an earlier run in the folder may be replaced
    bool checkpoints = true;       ///< whether checkpoints are written; false in a series of short renders
    std::string display_server{};  ///< HOST:PORT of a viewer with tev's protocol; "": none
};

/// Origin of a render, for its files: command and program.
struct RenderOrigin {
    std::string command{};          ///< as it was typed
    std::string debug_command{};    ///< reproduces a sample with " pass,x,y,sample" and --schedule appended
    Fingerprint fingerprint{};      ///< of this process
    std::string attempt{};          ///< attempt of treefarm launch; "" without launch
    std::string launch_warnings{};  ///< warnings of treefarm launch, which has printed them; "" if there are none
};

/// Workers of a render, and its interruption.
struct RenderWorkers {
    Channel* channel = nullptr;  ///< channel to running workers, which the caller dismisses
    LocalWorker local{};         ///< without a channel: worker in this process, dismissed at the end
    JobTurn turn{};              ///< among the jobs of a study
    /// Polled often; true interrupts the render, which can be resumed later.
    std::function<bool()> stop = [] { return false; };
};

/// Request of a render, read and checked (read_request()).
struct RenderRequest {
    RenderContent content{};
    RenderStart start{};
    RenderStorage storage{};
    RenderOrigin origin{};
    RenderWorkers workers{};
};

/// Initial state of a request without a checkpoint.
RenderState starting_state(const RenderRequest& request);

/// Pass planner of a request.
PassChooser passes_of(const RenderRequest& request);

}  // namespace treefarm
