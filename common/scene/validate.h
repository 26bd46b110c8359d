#pragma once

#include <vector>

#include "common/scene/scene.h"
#include "common/scene/warning.h"

namespace treefarm {

/// Checks a scene that a reader has put together. Indices out of range, values that are not finite, meshes without
/// triangles, spheres without a radius, reflectance outside [0, 1], negative radiance and a film that is not 1 to 65535
/// pixels throw InputError at the place of what is wrong. Triangles without area are removed, and a scene without
/// shapes or emitters is allowed: both give a warning.
void validate_scene(Scene& scene, std::vector<Warning>& warnings);

}  // namespace treefarm
