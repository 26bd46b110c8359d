// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/plan/effects/effects.h"

namespace treefarm {

/// A plan for people: what is on, what is off and why, what was forced off, kernels, memory. `scene` is the name of the
/// scene file. Ends with a line end.
std::string plan_text(const EffectPlan& plan, const std::string& scene);

/// A plan for programs (docs/generated/effects.md, "the JSON form"). Ends with a line end.
std::string plan_json(const EffectPlan& plan, const std::string& scene);

/// One line for the log: "bump is off for 3 places in the scene (scene.xml:4:5): bumpy surfaces are smooth".
std::string approximation_text(const Approximation& approximation);

/// "1.5 MiB".
std::string bytes_text(std::uint64_t bytes);

}  // namespace treefarm
