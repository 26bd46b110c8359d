// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/scene/model/scene.h"
#include "coordinator/input/check/warning.h"

namespace treefarm {

/// Checks a scene that a reader has put together: every index, every number's domain as the scene's headers state it,
/// and that coordinates stay below 1e18. What is wrong throws InputError at its place. Triangles without area are
/// removed, roughness below 1e-4 is raised to it, and factors that a texture takes above 1 are scaled down (or stay, in
/// materials that are unlimited); these, and
/// a scene without shapes or emitters, give a warning.
void validate_scene(Scene& scene, std::vector<Warning>& warnings);

}  // namespace treefarm
