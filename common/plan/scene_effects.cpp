// SPDX-License-Identifier: Apache-2.0
#include "common/plan/scene_effects.h"

#include <algorithm>
#include <vector>

#include "common/base/build_options.h"
#include "common/base/error.h"
#include "common/plan/effect_finder.h"

namespace treefarm {
namespace {

/// A name of TREEFARM_WITHOUT (empty: never left out) with the effects of effect_table() that it stands for.
struct Option {
    std::string name;
    bool built;
    std::vector<std::string> effects;
    bool SceneEffects::*flag;
};

const std::vector<Option>& options() {
    static const std::vector<Option> all = {
        {"textures", kHasTextures, {"textures", "textured_area"}, &SceneEffects::textures},
        {"masks", kHasMasks, {"masks"}, &SceneEffects::masks},
        {"bump", kHasBump, {"bump", "normal_maps"}, &SceneEffects::bump},
        {"", true, {"anisotropy"}, &SceneEffects::anisotropy},
        {"transmission", kHasTransmission, {"transmission"}, &SceneEffects::transmission},
        {"environment", kHasEnvironment, {"environment"}, &SceneEffects::environment},
        {"lens", kHasLens, {"lens"}, &SceneEffects::lens},
    };
    return all;
}

}  // namespace

SceneEffects find_scene_effects(const Scene& scene, const Job& job) {
    std::vector<std::string> left_out;
    left_out.reserve(options().size());
    for (const Option& option : options())
        if (!option.built) left_out.push_back(option.name);
    return find_scene_effects(scene, job, left_out);
}

SceneEffects find_scene_effects(const Scene& scene, const Job& job, std::span<const std::string> left_out) {
    const Resolved resolved = resolve(job, scene);
    const EffectFinder finder(scene, resolved);
    SceneEffects on;
    for (const Option& option : options()) {
        const bool missing = std::find(left_out.begin(), left_out.end(), option.name) != left_out.end();
        for (const std::string& name : option.effects) {
            const Effect effect = finder.find(name);
            if (!effect.on) continue;
            if (missing)
                throw RunError((effect.where.file.empty() ? "" : effect.where.text() + ": ") +
                               "the scene calls for the effect \"" + name + "\" (" + effect.reason +
                               "), which this program was built without; build it without \"" + option.name +
                               "\" in CMake's TREEFARM_WITHOUT");
            on.*option.flag = true;
        }
    }
    return on;
}

}  // namespace treefarm
