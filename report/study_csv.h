// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "report/study_results.h"

namespace treefarm {

/// One line per cell, with the figures of its last pass.
std::string cells_csv(const StudyResults& results);

/// One line per cell and pass.
std::string passes_csv(const StudyResults& results);

}  // namespace treefarm
