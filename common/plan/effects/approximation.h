// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/config/job.h"
#include "common/scene/model/scene.h"

namespace treefarm {

/// An effect that the scene uses and the job has switched off.
struct Approximation {
    std::string effect;  ///< name: "bump"
    int uses = 0;        ///< number of uses in the scene
    Location where;      ///< the first use
    std::string text;    ///< one line: what the image shows in its place
};

/// Removes the effects named in job.effects.off from the scene, and everything that is unused then, so that they cost
/// workers nothing. Returns what the scene lost, in the order of effect_switches(); effects that the scene does not use
/// are not listed.
std::vector<Approximation> switch_effects_off(Scene& scene, const Job& job);

/// Removes everything unused from a scene (remove_unused), and the texture coordinates of meshes without textures, so
/// that it is neither broadcast nor held by workers.
void strip_scene(Scene& scene);

}  // namespace treefarm
