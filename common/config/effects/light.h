// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tuple>

#include "common/config/effects/row.h"

namespace treefarm {

inline constexpr auto kLightEffects = std::tuple(
    effect(
        {"next_event", "light", "emitters are sampled directly at every surface that is hit",
         "`integrator.next_event` is not never, and there are emitters",
         "a choice and a shadow ray per vertex; tables: see the emitters"},
        [](const auto& find) { return find.next_event(); }, instead("set integrator.next_event = \"never\"")),
    effect(
        {"mis", "light", "next event and scattering are weighed against each other (Veach 1997)", "with next event",
         "no memory; a density per vertex"},
        [](const auto& find) { return find.mis(); },
        instead("it comes with next event: set integrator.next_event = \"never\"")),
    effect(
        {"kickstart", "light", "next event only in passes that start with fewer than 128 spp done",
         "`integrator.next_event` is kickstart", "no memory"},
        [](const auto& find) { return find.kickstart(); },
        instead(R"(set integrator.next_event = "always" or "never")")),

    effect_of_kind({"area", "light", "surfaces that emit", "a shape has an emitter",
                    "128 bytes per emitter, 12 per emitting triangle"},
                   EffectFamily::emitters, instead("remove the emitters from the scene")),
    effect(
        {"textured_area", "light", "emission that a texture varies", "an area emitter's radiance is a texture",
         "a lookup where it is hit; the image counts with bitmaps"},
        [](const auto& find) { return find.textured_area(); },
        replaced(7, "area emitters have the mean of their texture", [](auto& scene) { scene.textured_area(); })),

    effect(
        {"delta_lights", "light", "emitters that no ray can hit", "there are * emitters", "128 bytes per emitter"},
        [](const auto& find) { return find.delta_lights(); },
        replaced(8, "emitters that no ray can hit are dark", [](auto& scene) { scene.delta_lights(); })),
    effect_of_kind(
        {"point", "light", "a point that shines in all directions", "the scene has one", "with delta_lights"},
        EffectFamily::emitters, part_of("delta_lights")),
    effect_of_kind({"spot", "light", "a point that shines along a cone", "the scene has one", "with delta_lights"},
                   EffectFamily::emitters, part_of("delta_lights")),
    effect_of_kind({"directional", "light", "parallel light", "the scene has one", "with delta_lights"},
                   EffectFamily::emitters, part_of("delta_lights")),
    effect_of_kind({"projector", "light", "a picture thrown from a point", "the scene has one", "with delta_lights"},
                   EffectFamily::emitters, part_of("delta_lights")),

    effect(
        {"environment", "light", "light from infinity", "there is a constant emitter or an environment map",
         "see the two kinds"},
        [](const auto& find) { return find.environment(); },
        replaced(9, "it is dark around the scene", [](auto& scene) { scene.environment(); })),
    effect_of_kind({"constant", "light", "the same radiance from everywhere", "the scene has one", "128 bytes"},
                   EffectFamily::emitters, part_of("environment")),
    effect_of_kind({"environment_map", "light", "an image around the scene, a sky model's among them",
                    "the scene has one", "its pixels, 4 bytes per pixel to sample it; a lookup per ray that leaves"},
                   EffectFamily::emitters, part_of("environment")));

}  // namespace treefarm
