// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "common/base/log.h"
#include "coordinator/passes/pass_loop.h"
#include "coordinator/run/life_status.h"

namespace treefarm {

struct RenderOutcome;

/// Callbacks of a running render, in the thread that called render(). Any of them may be empty; their time counts as
/// the render's.
struct RenderObserver {
    TellMessage message;                   ///< each line of its log
    std::function<void(LifePhase)> phase;  ///< start of a phase; during LifePhase::pass, progress() is called instead
    std::function<void(const RenderProgress&, const Roster&)> progress;  ///< called many times a second
    /// Called after each pass, with the image so far. Decisions of the pass: decision_texts().
    std::function<void(const PassReport&, const CombinedImage&)> pass;
    std::function<void(const RenderOutcome&)> end;  ///< called once, unless an exception leaves the render
};

}  // namespace treefarm
