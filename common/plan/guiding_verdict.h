// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/film/guiding_worth.h"
#include "common/plan/schedule.h"

namespace treefarm {

/// Verdict on guiding after a guided pass, by its own worth and that of the guided pass before. The trees of short
/// passes still get better, which is why those are judged mildly; one that is not worth more than the last shows that
/// it does not, and is judged as a long one.
Guiding judge_guiding(const PassPlan& pass, const GuidingWorth& worth, const GuidingWorth& before, double mistrust);

}  // namespace treefarm
