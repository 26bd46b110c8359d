// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/config/job.h"
#include "common/scene/model/scene.h"

namespace treefarm {

/// An effect that the scene calls for and the job has forced off.
struct Approximation {
    std::string effect;  ///< its name: "bump"
    int uses = 0;        ///< places in the scene that called for it
    Location where;      ///< the first of them
    std::string text;    ///< one line: what the image shows in its place
};

/// Edits the scene so that the effects that job.effects.off names are not in it, and removes what nothing uses any
/// more: what is off costs workers nothing. Returns what the scene lost by it, in the order of effect_switches(). An
/// effect that the scene does not call for is no approximation.
std::vector<Approximation> switch_effects_off(Scene& scene, const Job& job);

}  // namespace treefarm
