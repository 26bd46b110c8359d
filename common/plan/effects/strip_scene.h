// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/model/scene.h"

namespace treefarm {

/// Removes everything unused from a scene (remove_unused), and the texture coordinates of meshes without textures, so
/// that it is neither broadcast nor held by workers.
void strip_scene(Scene& scene);

}  // namespace treefarm
