// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/scene/model/scene.h"
#include "coordinator/input/check/warning.h"

namespace treefarm {

/// Checks a scene made by a reader: every index, every number's domain as stated in the scene's headers, and that
/// coordinates are below 1e18. Throws InputError at the fault's location. With a warning it removes triangles without
/// area, raises roughness below 1e-4 to it, and scales down factors above 1 from textures (or keeps them in unlimited
/// materials); a scene without shapes or emitters gives a warning, too.
void validate_scene(Scene& scene, std::vector<Warning>& warnings);

}  // namespace treefarm
