// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "report/study_results.h"

namespace treefarm {

/// The report as one HTML page that needs nothing beside it. Throws RunError where gnuplot cannot draw.
std::string study_page(const StudyResults& results);

}  // namespace treefarm
