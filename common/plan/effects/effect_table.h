// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace treefarm {

/// An effect as docs/generated/effects.md has it, made from its row (common/config/effects/table.h).
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

/// Names of the effects that go off with this one: "point, spot or directional".
std::string names_of_parts(std::string_view whole);

/// A Markdown table of all effects, for docs/generated/effects.md.
std::string effect_documentation();

}  // namespace treefarm
