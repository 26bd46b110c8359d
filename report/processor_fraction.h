// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "report/study_results.h"

namespace treefarm {

/// Fraction of the processors below which seconds were affected by other programs.
inline constexpr double kLeastProcessorFraction = 0.8;

/// Fraction of their processors that a cell's workers had while tracing: core-seconds over seconds x threads. NaN if
/// unknown.
double processor_fraction(const CellResult& cell);

/// Whether some cell's workers had less than kLeastProcessorFraction.
bool was_busy(const StudyResults& results);

/// Warning about times measured on a busy processor; "" if there are none.
std::string busy_warning(const StudyResults& results);

}  // namespace treefarm
