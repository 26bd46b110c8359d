// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/config/job.h"
#include "common/scene/model/scene.h"

namespace treefarm {

/// The part of the plan that the worker holds against what happens: effects for which code is left out, or kept out of
/// line. In a debug build one that occurs although it is off here is an assertion.
struct SceneEffects {
    bool textures = false;  ///< of materials or area emitters
    bool masks = false;
    bool bump = false;  ///< or normal maps
    bool anisotropy = false;
    bool transmission = false;
    bool environment = false;
    bool lens = false;
};

/// The effects as the plan has them (EffectFinder).
SceneEffects find_scene_effects(const Scene& scene, const Job& job);

}  // namespace treefarm
