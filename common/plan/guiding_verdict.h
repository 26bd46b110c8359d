// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/film/guiding_efficiency.h"
#include "common/plan/schedule.h"

namespace treefarm {

/// Verdict after a guided pass that taught, from the efficiency of guiding times `mistrust`, the factor by which
/// unguided passes were noisier than guided samples had predicted. In doubt passes stay guided: guiding loses at most
/// its cost, unguided paths may lose without bound. If a tree is more efficient than `before`, the previous tree, the
/// next is expected to gain as much again and is judged in its place. Trees of short passes improve in any case, so
/// giving up needs stronger evidence there.
Guiding judge_guiding(const PassPlan& pass, const GuidingEfficiency& efficiency, const GuidingEfficiency& before,
                      double mistrust);

}  // namespace treefarm
