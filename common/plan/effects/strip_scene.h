// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/model/scene.h"

namespace treefarm {

/// Removes from a scene what nothing in it uses (remove_unused), and the texture coordinates of meshes that nothing is
/// looked up on. What is not there is neither broadcast nor held by workers.
void strip_scene(Scene& scene);

}  // namespace treefarm
