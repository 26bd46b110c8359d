// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "common/base/bytes.h"
#include "common/film/done_work.h"
#include "common/film/trace_stats.h"
#include "common/plan/forecast.h"
#include "common/plan/schedule.h"
#include "coordinator/ledger.h"

namespace treefarm {

/// What has come in of a pass that is not whole. With the state before the pass it is all that a render needs to go on
/// within it, on any farm.
struct PartialPass {
    PassPlan plan;
    BudgetMemory memory;  ///< NextPass::memory
    DoneWork done;
    Bytes film, aovs, splats, sums;  ///< each by the codec of its layer; empty where the pass has none
    TraceStats stats;
    std::uint64_t update_bytes = 0, splat_bytes = 0, touched_cells = 0;
    std::vector<PoisonUnit> poison_units;
    double collect_seconds = 0;  ///< of all lives of the render
    double run_seconds = 0;      ///< since its first request for work, of all lives
};

/// Whether the units are those that a pass of an image of this size can have: what is done, and of the rest some that
/// are deadly. The layers are another matter (Collector::restore).
bool has_possible_units(const PartialPass& partial, std::uint64_t pixels);

}  // namespace treefarm
