// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/film/guiding_efficiency.h"
#include "common/plan/schedule/schedule.h"

namespace treefarm {

/// Verdict after a guided pass that taught, by what its samples tell of unguided ones, times the factor `mistrust` by
/// which unguided passes were noisier than such samples had said. Guided is what stays where nobody knows: it loses at
/// most its cost, while unguided paths may lose without bound. A tree that is worth more than `before`, what is known
/// of the tree before it, is judged as the next one, which should be worth as much more again. The trees of short
/// passes get better in any case, so those have to say more loudly that guiding loses.
Guiding judge_guiding(const PassPlan& pass, const GuidingEfficiency& efficiency, const GuidingEfficiency& before,
                      double mistrust);

}  // namespace treefarm
