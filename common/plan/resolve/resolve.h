// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "common/config/job.h"
#include "common/decide/pass/judged_pass.h"
#include "common/scene/model/scene.h"

namespace treefarm {

/// Facts about a scene that decide the meaning of a job's settings.
struct SceneFacts {
    int whole_width = 512, whole_height = 512;  ///< of the film without crop window, pixels
    std::size_t film_pixels = 512 * 512;
    bool plainly_diffuse = false;     ///< no textures, lobes or tilted normals (material_traits.h)
    bool view_dependent = false;      ///< a surface scatters differently depending on the view direction
    bool chooses_lights = false;      ///< next event has several emitters, or an image, to choose from
    std::int16_t splat_exponent = 0;  ///< of the quantum of splats (splat_quantum.h)
    float ao_reach = 1.0f;            ///< a quarter of the diagonal of the scene's box
    bool lights_alone_find = false;   ///< some light is found only by paths from emitters: point lights seen in mirrors
};

SceneFacts facts_of(const Scene& scene);

/// A job with all settings decided for one scene: no value is "usual" or "auto"; type, rules, splitting, light
/// selection and thresholds are set. Decisions that need finished passes remain rules. resolve() leaves it unchanged,
/// so it can be written as a job (resolved.toml) and sent to workers.
struct Resolved : Job {
    SceneFacts scene_facts;
    bool guides = false;              ///< a guide is learned, and guides paths
    bool learns_views = false;        ///< the tree has a view-dependent part
    bool learns_emission = false;     ///< passes learn the emitter probabilities of light paths
    bool learns_lights = false;       ///< regions learn how next event chooses among emitters
    bool decides_next_event = false;  ///< finished passes decide how often emitters are sampled
    bool cells_follow_use = false;    ///< regions have fewer cells if the BSDF is sampled more often than their tree
};

/// Decisions that the job leaves to finished passes.
DecisionRules decision_rules(const Resolved& job);

/// Decides all settings that a job leaves to the program (docs/generated/jobs.md). Nothing else may do so. Pure.
Resolved resolve(const Job& job, const SceneFacts& scene);
Resolved resolve(const Job& job, const Scene& scene);

/// The guide as a value of the key guiding.type.
std::string guiding_word(const Resolved& job);

}  // namespace treefarm
