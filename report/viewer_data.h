// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "report/study_results.h"

namespace treefarm {

/// JSON for viewer.js: each method's image of the first seed, and the reference if there is one.
std::string viewer_data(const StudyResults& results, const SceneResult& scene);

}  // namespace treefarm
