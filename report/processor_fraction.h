// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "report/study_results.h"

namespace treefarm {

/// Below this the workers' seconds are not their own.
inline constexpr double kLeastProcessorFraction = 0.8;

/// The part of their processors that a cell's workers had while they traced: core-seconds over seconds x threads. NaN
/// where it is not known.
double processor_fraction(const CellResult& cell);

/// True where some cell's workers had less than kLeastProcessorFraction.
bool was_busy(const StudyResults& results);

/// Warning about times that were taken beside a busy processor; "" where none were.
std::string busy_warning(const StudyResults& results);

}  // namespace treefarm
