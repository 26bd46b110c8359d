// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/model/scene.h"

namespace treefarm {

/// Shares of the light of a scene's emitters by what is between them and the surfaces that the camera sees, estimated
/// with a few hundred rays; relative to the light without any obstacles.
struct LightReach {
    bool known = false;   ///< false: nothing is visible, nothing emits, or the scene is too large to examine
    double infinity = 0;  ///< light from emitters that surround the scene, or light it from one side
    double free = 0;      ///< light from other emitters, unobstructed
    double glass = 0;     ///< light from other emitters, through smooth glass first
    double blocked = 0;   ///< light from other emitters, behind another surface or facing away
};

/// Shares of a scene's light. Pure. Masks are ignored.
LightReach light_reach(const Scene& scene);

}  // namespace treefarm
