// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/plan/effects/effects.h"

namespace treefarm {

/// Plan in a few lines: size and samples, advice, memory, what is not found, approximations and warnings. Ends with a
/// line end.
std::string plan_brief(const EffectPlan& plan, const std::string& scene);

/// plan_brief(), and the lists: effects that are on, off (with reasons), memory by use, and kernels. `scene`: name of
/// the scene file. Ends with a line end.
std::string plan_text(const EffectPlan& plan, const std::string& scene);

/// Plan as JSON for programs (docs/generated/effects.md, "the JSON form"). Ends with a line end.
std::string plan_json(const EffectPlan& plan, const std::string& scene);

/// Log line such as "bump is off for 3 places in the scene (scene.xml:4:5): bumpy surfaces are smooth".
std::string approximation_text(const Approximation& approximation);

/// Bytes as text: "1.5 MiB".
std::string bytes_text(std::uint64_t bytes);

}  // namespace treefarm
