// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>

#include "common/scene/model/texture.h"

namespace treefarm {

template <class TextureRef>
concept IsTexture = std::same_as<std::remove_const_t<TextureRef>, Texture>;

/// Calls f(image index) for each image of a texture, by a modifiable reference.
template <IsTexture TextureRef, class F>
void for_each_image(TextureRef& texture, F&& f) {
    visit_fields(texture.kind, ImageVisitor<F>(f));
}

}  // namespace treefarm
