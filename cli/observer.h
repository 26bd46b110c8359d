// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "cli/on_farm.h"
#include "coordinator/render/render_series.h"
#include "coordinator/run/sign_of_life.h"

namespace treefarm {

/// Tells a person what a render says, and a supervisor (nullptr: there is none) that it gets on.
RenderObserver make_observer(const LogOutput& voice, const std::shared_ptr<SignOfLife>& life);

/// A series of renders, which speaks on the console and has a line for each of them: what happens within is told where
/// every figure was asked for, and otherwise no more than errors.
SeriesContext make_series(const RenderOrigin& origin, const RenderWorkers& workers, const LogOutput& voice,
                          const Log& log, const std::shared_ptr<SignOfLife>& life);

}  // namespace treefarm
