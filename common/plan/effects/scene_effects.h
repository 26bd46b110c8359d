// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/config/job.h"
#include "common/scene/model/scene.h"

namespace treefarm {

/// Effects that the worker's code depends on: code for other effects is skipped. In a debug build it is an assertion
/// that an effect that is off here does not occur.
struct SceneEffects {
    bool textures = false;  ///< of materials or area emitters
    bool masks = false;
    bool bump = false;  ///< bump or normal maps
    bool anisotropy = false;
    bool transmission = false;
    bool environment = false;
    bool lens = false;
};

/// Finds the effects by EffectFinder.
SceneEffects find_scene_effects(const Scene& scene, const Job& job);

}  // namespace treefarm
