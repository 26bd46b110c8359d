// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

namespace treefarm {

/// What an effect of the program is, for people: the rows of docs/generated/effects.md.
struct EffectDescription {
    std::string name;   ///< "bump"
    std::string group;  ///< "materials"
    std::string what;   ///< one line
    std::string when;   ///< when it is on
    std::string cost;   ///< in memory and in time
    bool simulated = true;
};

/// Every effect that the program knows, those that it never simulates last.
std::span<const EffectDescription> effect_table();

/// The kinds of emitters that no ray can hit: "point, spot or directional".
std::string delta_light_names();

/// A Markdown table of all effects, for docs/generated/effects.md.
std::string effect_documentation();

}  // namespace treefarm
