// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "common/base/log.h"
#include "coordinator/passes/pass_loop.h"
#include "coordinator/run/life_status.h"

namespace treefarm {

struct RenderOutcome;

/// Functions that a render calls while it runs, in the thread that asked for it. Any of them may be empty; what they
/// take counts as the render's time.
struct RenderObserver {
    TellMessage message;                   ///< each line of its log
    std::function<void(LifePhase)> phase;  ///< that begins; during LifePhase::pass, progress() is called instead
    std::function<void(const RenderProgress&, const Roster&)> progress;  ///< many times a second
    /// After each pass, with the image so far. What was decided with the pass: decision_texts().
    std::function<void(const PassReport&, const CombinedImage&)> pass;
    std::function<void(const RenderOutcome&)> end;  ///< once, unless an exception leaves the render
};

}  // namespace treefarm
