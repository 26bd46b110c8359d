// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "report/study_results.h"

namespace treefarm {

/// Cost of an effect, from two methods that differ only by its switch.
struct EffectCost {
    std::string effect;     ///< name of the switch, without "effects."
    std::string with, off;  ///< methods
    Interval core_seconds;  ///< ratio with over without, by pairs of seeds: 1.2 means a fifth more
};

/// Costs of all effects that a study switches off in this scene.
std::vector<EffectCost> effect_costs(const StudyResults& results, const SceneResult& scene);

/// Each method's plan as a table, equal ones once, with the measured costs of its effects.
std::string plan_tables(const StudyResults& results, const SceneResult& scene);

}  // namespace treefarm
