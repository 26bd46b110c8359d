// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "report/study_results.h"

namespace treefarm {

/// Pictures by `treefarm inspect` of the trees of a scene's cells (the first inspected cell of each method), as HTML;
/// "" without any. Throws InputError if an inspect.json is damaged.
std::string tree_pictures(const StudyResults& results, const SceneResult& scene);

}  // namespace treefarm
