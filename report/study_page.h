// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "report/study_results.h"

namespace treefarm {

/// Report as one self-contained HTML page. Throws RunError if gnuplot fails.
std::string study_page(const StudyResults& results);

}  // namespace treefarm
