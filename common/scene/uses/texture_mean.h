// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/model/scene.h"

namespace treefarm {

/// Mean of a texture over all its texels, each counted once.
Rgb texture_mean(const Scene& scene, std::int32_t texture);

/// Bytes of an image's pixels, its table included.
std::size_t image_bytes(const TextureImage& image);

}  // namespace treefarm
