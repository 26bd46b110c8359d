// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "report/study_results.h"

namespace treefarm {

/// Cost of an effect, by a method that differs from another only by having it off.
struct EffectCost {
    std::string effect;     ///< the switch's name, without "effects."
    std::string with, off;  ///< methods
    Interval core_seconds;  ///< with over without, by pairs of seeds: 1.2 is a fifth more
};

/// Costs of all effects that a study switches off on this scene.
std::vector<EffectCost> effect_costs(const StudyResults& results, const SceneResult& scene);

/// The plan of each method as a table, those that are alike once, with what was measured of its effects.
std::string plan_tables(const StudyResults& results, const SceneResult& scene);

}  // namespace treefarm
