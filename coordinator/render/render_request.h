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

/// What a render computes: everything read and checked.
struct RenderContent {
    Job job;
    Scene scene;                        ///< without the effects that the job forces off
    EffectPlan plan;                    ///< of both
    std::vector<PassPlan> schedule;     ///< these passes; empty: those of the job's budget
    std::vector<std::string> warnings;  ///< of the readers, for the log
    std::vector<std::string> notes;     ///< of the readers, other than faults
};

/// What a render begins with. Without either: the guide's first model, and no samples.
struct RenderStart {
    std::optional<AnyModel> model;                 ///< that guides the first pass
    std::shared_ptr<LoadedCheckpoint> checkpoint;  ///< what the render continues; its state is taken
};

/// What a render leaves, besides what job.output says (the run directory among it).
struct RenderStorage {
    bool overwrite = false;        ///< an earlier run in the folder may be replaced
    bool checkpoints = true;       ///< the render can be resumed; false: it is one of many that are short
    std::string display_server{};  ///< HOST:PORT of a viewer with tev's protocol; "": none
};

/// Who asked for a render, with which program: what its files say of its origin.
struct RenderOrigin {
    std::string command{};        ///< as it was typed
    std::string debug_command{};  ///< reproduces a sample with " pass,x,y,sample" and --schedule appended
    Fingerprint fingerprint{};    ///< of this process
    std::string attempt{};        ///< of treefarm launch; "" without
};

/// Who renders, and until when.
struct RenderWorkers {
    Channel* channel = nullptr;  ///< to workers that are there; the caller dismisses them
    LocalWorker local{};         ///< without a channel: runs one in this process, which is dismissed at the end
    JobTurn turn{};              ///< among the jobs of a study
    /// Asked often; true interrupts the render, which can be resumed then.
    std::function<bool()> stop = [] { return false; };
};

/// A render as it was asked for, read and checked (read_request()).
struct RenderRequest {
    RenderContent content{};
    RenderStart start{};
    RenderStorage storage{};
    RenderOrigin origin{};
    RenderWorkers workers{};
};

/// The state that a render without a checkpoint begins with.
RenderState starting_state(const RenderRequest& request);

/// The passes that a request asks for.
PassChooser passes_of(const RenderRequest& request);

}  // namespace treefarm
