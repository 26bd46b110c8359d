// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace treefarm {

/// Description of an effect for docs/generated/effects.md, from its row in common/config/effects/table.h.
struct EffectDescription {
    std::string name;   ///< "bump"
    std::string group;  ///< "materials"
    std::string what;   ///< one line
    std::string when;   ///< condition under which it is on
    std::string cost;   ///< cost in memory and in time
    bool simulated = true;
};

/// All effects that the program knows; those that it never simulates come last.
std::span<const EffectDescription> effect_table();

/// Names of the effects that are switched off with this one: "point, spot or directional".
std::string names_of_parts(std::string_view whole);

/// Markdown table of all effects, for docs/generated/effects.md.
std::string effect_documentation();

}  // namespace treefarm
