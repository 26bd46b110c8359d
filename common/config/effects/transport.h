// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tuple>

#include "common/config/effects/row.h"

namespace treefarm {

inline constexpr auto kTransportEffects = std::tuple(
    effect(
        {"guiding", "transport", "directions drawn from what earlier passes learned (Mueller et al. 2017)",
         "`guiding.type` is not none and there is more than one pass",
         "560 bytes per region and 8 per cell; a lookup per vertex"},
        [](const auto& find) { return find.guiding(); }, instead("set guiding.type = \"none\"")),
    effect(
        {"views", "transport", "where rough surfaces were met, directions by where light goes, too (Cavus 2020)",
         "`guiding.type` is view or auto, a material is rough, and there is more than one pass",
         "32 bytes per view and 8 per cell, at most half of the regions' cells; a lookup more per vertex there"},
        [](const auto& find) { return find.views(); }, instead("set guiding.type = \"ppg\"")),
    effect(
        {"recording", "transport", "paths teach the tree", "with guiding, in all passes but the last",
         "13 bytes per cell and 22 per region, 150 where the mixture is learned; a record per vertex"},
        [](const auto& find) { return find.recording(); }, instead("set guiding.type = \"none\"")),
    effect(
        {"light_subpaths", "transport", "paths that start from emitters, not from the camera alone (Veach 1997)",
         "`integrator.type` is light or bidirectional, and there are emitters",
         "a second path per sample where paths from the camera stay: a bidirectional sample takes 2 to 3 times as "
         "long"},
        [](const auto& find) { return find.light_subpaths(); }, instead("set integrator.type = \"path\"")),
    effect(
        {"light_image", "transport", "light paths are connected to the lens, and splat the pixel that they fall on",
         "with light_subpaths; of bidirectional, `bidirectional.light_image`, too",
         "96 bytes a pixel, and as much again to send them; a shadow ray per vertex of a light path"},
        [](const auto& find) { return find.light_image(); },
        instead("set bidirectional.light_image = false, or integrator.type = \"path\"")),
    effect(
        {"connections", "transport", "vertices of a path from the camera are connected with those of a light path",
         "`integrator.type` is bidirectional, with light_subpaths",
         "a shadow ray and two evaluated BSDFs per pair of vertices that is not black"},
        [](const auto& find) { return find.connections(); }, instead(R"(set integrator.type = "path" or "light")")),
    effect(
        {"roulette", "transport", "Russian roulette ends paths that carry little",
         "paths may be longer than `integrator.rr_depth`", "no memory"},
        [](const auto& find) { return find.roulette(); },
        instead("set integrator.rr_depth above integrator.max_depth")),
    effect(
        {"depth_limit", "transport", "paths end at a given length: light is lost", "`integrator.max_depth` is set",
         "no memory"},
        [](const auto& find) { return find.depth_limit(); }, instead("set integrator.max_depth = -1")),
    effect(
        {"strict_normals", "transport", "light that geometric and shading normal disagree about is dropped",
         "`integrator.strict_normals`", "no memory"},
        [](const auto& find) { return find.strict_normals(); }, instead("set integrator.strict_normals = false")),
    effect(
        {"hidden_emitters", "transport", "the camera does not see emitters", "`integrator.hide_emitters`", "no memory"},
        [](const auto& find) { return find.hidden_emitters(); }, instead("set integrator.hide_emitters = false")));

/// Group of effects that this program does not simulate.
inline constexpr char kNeverGroup[] = "never";

constexpr auto never(const char* name, const char* what) {
    return effect(
        {name, kNeverGroup, what, "", ""}, [](const auto& find) { return find.never(); },
        instead("it is never simulated"));
}

inline constexpr auto kNeverEffects =
    std::tuple(never("media", "fog, smoke and clouds"), never("subsurface", "light that wanders below surfaces"),
               never("motion", "motion blur"), never("polarisation", "polarised light"),
               never("dispersion", "refraction by wavelength"));

}  // namespace treefarm
