// SPDX-License-Identifier: Apache-2.0
#include "common/config/effect_switches.h"

#include <vector>

namespace treefarm {

std::span<const EffectSwitch> effect_switches() {
    static const std::vector<EffectSwitch> switches = {
        {"textures", "materials have the mean of each texture"},
        {"masks", "masked surfaces are whole"},
        {"bump", "bumpy surfaces are smooth"},
        {"normal_maps", "normals are the geometry's"},
        {"transmission", "dielectrics only reflect; what they would let through is lost"},
        {"anisotropy", "roughness is the same along and across"},
        {"textured_area", "area emitters have the mean of their texture"},
        {"delta_lights", "emitters that no ray can hit are dark"},
        {"environment", "it is dark around the scene"},
        {"lens", "everything is in focus"},
    };
    return switches;
}

std::span<const std::pair<std::string, std::string>> effects_without_switch() {
    static const std::vector<std::pair<std::string, std::string>> effects = {
        {"next_event", "set integrator.next_event = \"never\""},
        {"mis", "it comes with next event: set integrator.next_event = \"never\""},
        {"area", "remove the emitters from the scene"},
        {"point", "switch off effects.delta_lights"},
        {"spot", "switch off effects.delta_lights"},
        {"directional", "switch off effects.delta_lights"},
        {"projector", "switch off effects.delta_lights"},
        {"constant", "switch off effects.environment"},
        {"environment_map", "switch off effects.environment"},
        {"bitmaps", "switch off effects.textures"},
        {"checkerboards", "switch off effects.textures"},
        {"diffuse", "change the scene's materials"},
        {"delta_reflection", "change the scene's materials"},
        {"microfacets", "change the scene's materials"},
        {"blends", "change the scene's materials"},
        {"rough_diffuse", "change the scene's materials"},
        {"phong", "change the scene's materials"},
        {"principled", "change the scene's materials"},
        {"principled_thin", "change the scene's materials"},
        {"coatings", "change the scene's materials"},
        {"ward", "change the scene's materials"},
        {"coats", "change the scene's materials"},
        {"null", "change the scene's materials"},
        {"twosided", "change the scene's materials"},
        {"instances", "change the scene's shapes"},
        {"analytic_shapes", "change the scene's shapes"},
        {"triangles", "change the scene's shapes"},
        {"smooth_normals", "set faceNormals in the scene's shapes"},
        {"guiding", "set guiding.type = \"none\""},
        {"views", "set guiding.type = \"ppg\""},
        {"recording", "set guiding.type = \"none\""},
        {"kickstart", "set integrator.next_event = \"always\" or \"never\""},
        {"roulette", "set integrator.rr_depth above integrator.max_depth"},
        {"depth_limit", "set integrator.max_depth = -1"},
        {"strict_normals", "set integrator.strict_normals = false"},
        {"hidden_emitters", "set integrator.hide_emitters = false"},
        {"pixel_filter", "set a box filter in the scene's film"},
        {"media", "it is never simulated"},
        {"subsurface", "it is never simulated"},
        {"motion", "it is never simulated"},
        {"polarisation", "it is never simulated"},
        {"dispersion", "it is never simulated"},
    };
    return effects;
}

}  // namespace treefarm
