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

/// Whether an effect of the program is simulated in a render, and why.
struct Effect {
    std::string name;   ///< as in effect_table()
    std::string group;  ///< "light", "materials", "shapes", "camera", "transport", "never"
    bool on = false;
    std::string reason;       ///< one line
    Location where;           ///< the first place in the scene that calls for it; empty: the job or the sensor does
    std::uint64_t bytes = 0;  ///< expected in one worker because of it; 0 when off

    bool operator==(const Effect& other) const {
        return name == other.name && group == other.group && on == other.on && reason == other.reason &&
               where.text() == other.where.text() && bytes == other.bytes;
    }
};

/// Every effect in the order of effect_table(), as this scene and job have it.
std::vector<Effect> find_effects(const Scene& scene, const Resolved& job);

/// What a render simulates, with what, and what it is expected to cost.
struct EffectPlan {
    Resolved job;  ///< for the scene that is left
    int width = 0, height = 0;
    std::uint32_t spp = 0;  ///< rounded up to whole passes' units
    std::size_t pass_count = 0;
    bool passes_guessed = false;  ///< the budget leaves spp and passes open: figures are for these
    std::size_t triangles = 0;
    std::vector<Effect> effects;
    std::vector<std::string> misses;  ///< light that the estimator never finds in this scene
    std::vector<Approximation> approximations;
    std::vector<KernelUse> kernels;
    MemoryPlan memory;
    std::string advice;                 ///< which estimator suits the scene, and why; empty: nobody looked
    std::vector<std::string> warnings;  ///< what reading the scene had to replace or leave out

    const Effect* find(const std::string& name) const;
};

/// Takes the effects that the job forces off out of the scene, and what nothing uses (switch_effects_off), and plans
/// the rest.
EffectPlan plan_effects(Scene& scene, const Job& job);

}  // namespace treefarm
