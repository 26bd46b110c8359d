// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/config/job.h"
#include "common/plan/effects/approximation.h"
#include "common/plan/forecast/memory.h"
#include "common/plan/schedule/kernel.h"
#include "common/scene/model/scene.h"

namespace treefarm {

/// State of an effect in a render, with the reason.
struct Effect {
    std::string name;   ///< as in effect_table()
    std::string group;  ///< "light", "materials", "shapes", "camera", "transport", "never"
    bool on = false;
    std::string reason;       ///< one line
    Location where;           ///< first location in the scene that uses it; empty: job or sensor does
    std::uint64_t bytes = 0;  ///< expected memory in one worker because of it; 0 if off

    bool operator==(const Effect& other) const {
        return name == other.name && group == other.group && on == other.on && reason == other.reason &&
               where.text() == other.where.text() && bytes == other.bytes;
    }
};

/// State of all effects for this scene and job, in the order of effect_table().
std::vector<Effect> find_effects(const Scene& scene, const Resolved& job);

/// Plan of a render: effects, kernels, and expected cost.
struct EffectPlan {
    Resolved job;  ///< for the scene after removal of effects
    int width = 0, height = 0;
    std::uint32_t spp = 0;  ///< rounded up to whole units of passes
    std::size_t pass_count = 0;
    bool passes_guessed = false;  ///< the budget does not fix spp and passes: figures assume these
    std::size_t triangles = 0;
    std::vector<Effect> effects;
    std::vector<std::string> misses;  ///< light that the estimator never finds in this scene
    std::vector<Approximation> approximations;
    std::vector<KernelUse> kernels;
    MemoryPlan memory;
    std::string advice;                 ///< which estimator suits the scene, and why; empty: not examined
    std::vector<std::string> warnings;  ///< what the scene reader replaced or skipped

    const Effect* find(const std::string& name) const;
};

/// Removes the effects that the job switches off, and everything unused, from the scene (switch_effects_off), and plans
/// the rest.
EffectPlan plan_effects(Scene& scene, const Job& job);

}  // namespace treefarm
