#pragma once

#include "common/scene/scene.h"

namespace treefarm {

/// Removes from a scene what nothing in it uses: textures, images, and the texture coordinates of meshes that nothing
/// is looked up on. Other indices keep their meaning. What is not there is neither broadcast nor held by workers.
void strip_scene(Scene& scene);

}  // namespace treefarm
