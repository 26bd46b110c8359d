// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/scene/model/scene.h"

namespace treefarm {

/// Removes materials that no shape has, textures that no material and no emitter uses, and images that no texture and
/// no emitter uses; indices follow. Returns the new index of every image that there was, or kNone.
std::vector<std::int32_t> remove_unused(Scene& scene);

}  // namespace treefarm
