// SPDX-License-Identifier: Apache-2.0
#include "common/plan/effects/scene_effects.h"

#include "common/config/effects/table.h"
#include "common/plan/effects/effect_finder.h"

namespace treefarm {

SceneEffects find_scene_effects(const Scene& scene, const Job& job) {
    static constexpr struct {
        EffectId effect;
        bool SceneEffects::*flag;
    } kFlags[] = {{"textures", &SceneEffects::textures},
                  {"textured_area", &SceneEffects::textures},
                  {"masks", &SceneEffects::masks},
                  {"bump", &SceneEffects::bump},
                  {"normal_maps", &SceneEffects::bump},
                  {"anisotropy", &SceneEffects::anisotropy},
                  {"transmission", &SceneEffects::transmission},
                  {"environment", &SceneEffects::environment},
                  {"lens", &SceneEffects::lens}};
    const Resolved resolved = resolve(job, scene);
    const EffectFinder finder(scene, resolved);
    SceneEffects on;
    for (const auto& [effect, flag] : kFlags)
        if (finder.find(effect).on) on.*flag = true;
    return on;
}

}  // namespace treefarm
