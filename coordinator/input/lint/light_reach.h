// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/model/scene.h"

namespace treefarm {

/// How the light of a scene's emitters comes to what its camera sees, as far as a few hundred rays tell: shares of what
/// it would be if nothing lay between.
struct LightReach {
    bool known = false;   ///< false: nothing is seen, nothing shines, or the scene is too large to be looked at
    double infinity = 0;  ///< from emitters that surround the scene, or shine on it from one side
    double free = 0;      ///< of the others: nothing lies between
    double glass = 0;     ///< of the others: smooth glass does first
    double blocked = 0;   ///< of the others: anything else does, or the emitter faces away
};

/// Pure. Masks are not looked up.
LightReach light_reach(const Scene& scene);

}  // namespace treefarm
