// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/decide/pass/pass_plan.h"
#include "common/film/trace_counts.h"

namespace treefarm {

/// Cost of a camera sample in closest-hit rays of unguided paths; of next event only the shadow rays count.
double sample_cost(const PassPlan& plan, const TraceCounts& counts);

}  // namespace treefarm
