// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "report/study_results.h"

namespace treefarm {

/// Each method's image of the first seed, and the reference where there is one, for viewer.js.
std::string viewer_data(const StudyResults& results, const SceneResult& scene);

}  // namespace treefarm
