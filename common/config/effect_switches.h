// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <utility>

namespace treefarm {

/// Job keys that come from the table of effects (common/config/effects/table.h).

/// Prefix of the job keys that switch an effect off: "effects.bump".
inline constexpr char kEffectsPrefix[] = "effects.";

/// An effect that a job can switch off.
struct EffectSwitch {
    std::string name;         ///< "bump"
    std::string replacement;  ///< what the image shows in its place
};

/// All effects that a job can switch off, in the order of job.toml.
std::span<const EffectSwitch> effect_switches();

/// Effects without a switch: name, and what to do instead.
std::span<const std::pair<std::string, std::string>> effects_without_switch();

}  // namespace treefarm
