// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "report/study_results.h"

namespace treefarm {

/// Pictures that `treefarm inspect` drew of the trees of a scene's cells (the first of each method that it was asked
/// about), as HTML; "" where it was never asked. Throws InputError where an inspect.json is damaged.
std::string tree_pictures(const StudyResults& results, const SceneResult& scene);

}  // namespace treefarm
