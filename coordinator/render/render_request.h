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

/// Content of a render, read and checked.
struct RenderContent {
    Job job;
    Scene scene;                        ///< without the effects that the job forces off
    EffectPlan plan;                    ///< of both
    std::vector<PassPlan> schedule;     ///< listed passes; empty: by the job's budget
    std::vector<std::string> warnings;  ///< of the readers, for the log
    std::vector<std::string> notes;     ///< of the readers, of what is no fault
};

/// Start of a render. Empty: the guide's first model, and no samples.
struct RenderStart {
    std::optional<AnyModel> model;                 ///< that guides the first pass
    std::shared_ptr<LoadedCheckpoint> checkpoint;  ///< checkpoint to continue; its state is moved out
};

/// Files and displays of a render, besides those of job.output, which names the run directory.
struct RenderStorage {
    bool overwrite = false;        ///< an earlier run in the folder may be replaced
    bool checkpoints = true;       ///< the render can be resumed; false: it is one of many that are short
    std::string display_server{};  ///< HOST:PORT of a viewer that speaks tev's protocol; "": none
};

/// Origin of a render, for its files: the command and the program.
struct RenderOrigin {
    std::string command{};        ///< as it was typed
    std::string debug_command{};  ///< reproduces a sample with " pass,x,y,sample" and --schedule appended
    Fingerprint fingerprint{};    ///< of this process
    std::string attempt{};        ///< of treefarm launch; "" without
};

/// Workers of a render, and its stop flag.
struct RenderWorkers {
    Channel* channel = nullptr;  ///< to workers of the caller, who dismisses them
    LocalWorker local{};         ///< without a channel: a worker in this process, dismissed at the end
    JobTurn turn{};              ///< among the jobs of a study
    /// Asked often; true interrupts the render, which can be resumed then.
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

/// State at the start of a render without a checkpoint.
RenderState starting_state(const RenderRequest& request);

/// Passes of a request, one after the other.
PassChooser passes_of(const RenderRequest& request);

}  // namespace treefarm
