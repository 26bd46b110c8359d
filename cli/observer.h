// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "cli/on_farm.h"
#include "coordinator/render/render_series.h"
#include "coordinator/run/sign_of_life.h"

namespace treefarm {

/// Observer that prints a render's messages for the user, and reports its progress to a supervisor (nullptr: none).
RenderObserver make_observer(const LogOutput& log_output, const std::shared_ptr<SignOfLife>& life);

/// Context of a series of renders with one console line per render; details of a render are printed only if verbose,
/// otherwise its errors.
SeriesContext make_series(const RenderOrigin& origin, const RenderWorkers& workers, const LogOutput& log_output,
                          const Log& log, const std::shared_ptr<SignOfLife>& life);

}  // namespace treefarm
