// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "common/base/log.h"
#include "coordinator/passes/pass_loop.h"
#include "coordinator/run/life_status.h"

namespace treefarm {

struct RenderOutcome;

/// Functions that a render calls in the thread of its caller. Any of them may be empty; their time counts as the
/// render's.
struct RenderObserver {
    TellMessage message;                   ///< each line of its log
    std::function<void(LifePhase)> phase;  ///< that begins; during LifePhase::pass, progress() is called instead
    std::function<void(const RenderProgress&, const Roster&)> progress;  ///< many times a second
    /// Called after each pass, with the image so far; decision_texts() tells the pass's decisions.
    std::function<void(const PassReport&, const CombinedImage&)> pass;
    std::function<void(const RenderOutcome&)> end;  ///< once, unless an exception leaves the render
};

}  // namespace treefarm
