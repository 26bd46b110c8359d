// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "common/config/job.h"
#include "common/scene/model/scene.h"

namespace treefarm {

/// Facts of a scene that decide what a job's settings mean.
struct SceneFacts {
    int whole_width = 512, whole_height = 512;  ///< of the film, a crop window apart, pixels
    std::size_t film_pixels = 512 * 512;
    bool plainly_diffuse = false;     ///< no textures, lobes or tilted normals (material_traits.h)
    bool view_dependent = false;      ///< a surface scatters otherwise by where it is seen from
    bool chooses_lights = false;      ///< next event has more than one emitter, or an image, to choose from
    std::int16_t splat_exponent = 0;  ///< of the quantum of splats (splat_quantum.h)
    float ao_reach = 1.0f;            ///< a quarter of the diagonal of the scene's box
    bool lights_alone_find = false;   ///< some light only paths from emitters find: that of points by way of mirrors
};

SceneFacts facts_of(const Scene& scene);

/// A job as it is carried out on one scene. None of its values says "as usual" or "auto": type, rules, splitting,
/// light selection and thresholds are set. What only finished passes can decide stands there as a rule. resolve() of it
/// gives it back, so it can be written as a job (resolved.toml) and sent to workers.
struct Resolved : Job {
    SceneFacts scene_facts;
    bool guides = false;              ///< a tree is learned, and guides paths
    bool learns_views = false;        ///< the tree has a view-dependent part
    bool learns_emission = false;     ///< passes learn how often light paths start from each emitter
    bool learns_lights = false;       ///< regions learn how next event chooses among emitters
    bool decides_next_event = false;  ///< finished passes say how often emitters are sampled
    bool cells_follow_use = false;    ///< regions get fewer cells where the BSDF is sampled rather than their tree
};

/// The only place that knows what a setting left to the program means (docs/generated/jobs.md). Pure.
Resolved resolve(const Job& job, const SceneFacts& scene);
Resolved resolve(const Job& job, const Scene& scene);

/// The guide, in the word of the key guiding.type.
std::string guiding_word(const Resolved& job);

}  // namespace treefarm
