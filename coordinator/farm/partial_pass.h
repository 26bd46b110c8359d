// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "common/base/bytes.h"
#include "common/film/done_work.h"
#include "common/film/trace_stats.h"
#include "common/plan/forecast/forecast.h"
#include "common/plan/schedule/schedule.h"
#include "coordinator/farm/ledger.h"

namespace treefarm {

/// Results received so far of an incomplete pass. Together with the state before the pass they suffice to resume within
/// it, on any farm.
struct PartialPass {
    PassPlan plan;
    BudgetMemory memory;  ///< NextPass::memory
    DoneWork done;
    Bytes film, aovs, splats;  ///< each encoded by its layer's codec; empty if the pass lacks the layer
    Bytes evidence;            ///< Evidence::encode()
    TraceStats stats;
    std::uint64_t update_bytes = 0, splat_bytes = 0, touched_cells = 0;
    std::vector<PoisonUnit> poison_units;
    double collect_seconds = 0;  ///< including the time before a resume
    double run_seconds = 0;      ///< since the first request for work, including the time before a resume
};

/// Whether the units are possible for a pass of an image of this size: finished ones, and some poison units among the
/// rest. The layers are checked by Collector::restore.
bool has_possible_units(const PartialPass& partial, std::uint64_t pixels);

}  // namespace treefarm
