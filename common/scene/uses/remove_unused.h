// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/scene/model/scene.h"

namespace treefarm {

/// Removes materials without shapes, textures without materials and emitters, and images without textures and emitters,
/// and adjusts indices. Returns the new index of each image, or kNone.
std::vector<std::int32_t> remove_unused(Scene& scene);

}  // namespace treefarm
