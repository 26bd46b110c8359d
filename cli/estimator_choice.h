// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "cli/plan_answer.h"
#include "coordinator/input/lint/estimator_advice.h"

namespace treefarm {

/// Expected speed of a render by another estimator, to equal error and in multiples of the own one; 0 if one of the two
/// is unknown. The interval takes both probes for independent.
Expected times_as_fast(const Expectation& other, const Expectation& own);

/// Advice in words, from probes of both estimators: to take the other one only where it is surely faster. "": nothing
/// can be said.
std::string estimator_choice_text(const EstimatorAdvice& other, const std::string& own, const Expected& times_as_fast);

/// Words where no probe has compared them: how to compare, and no advice.
std::string untried_estimator_text(const EstimatorAdvice& other, const std::string& own);

}  // namespace treefarm
