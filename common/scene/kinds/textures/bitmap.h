// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/kinds/traits/texture_traits.h"

namespace treefarm {

/// Extension of an image outside of [0, 1) in u or v.
enum class Wrap : std::uint8_t { repeat, mirror, clamp, zero, one };

/// Texture from an image. Texel (column, row from the top) covers u in [column, column+1) / width and v in [row, row+1)
/// / height: v runs down the image; readers convert formats with other conventions.
struct BitmapTexture {
    std::int32_t image = kNone;  ///< index in Scene::images
    bool bilinear = true;        ///< otherwise the nearest texel
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
    UvTransform uv;

    static constexpr KindEffect kEffect{"bitmaps", "bitmap"};
    bool has_beyond(Wrap wrap) const { return wrap_u == wrap || wrap_v == wrap; }
    ValueRange range(const auto& scene) const {
        ValueRange range = scene.range_of_image(image);
        if (has_beyond(Wrap::zero)) range = range.with(0.0f);
        if (has_beyond(Wrap::one)) range = range.with(1.0f);
        return range;
    }
    Rgb mean(const auto& scene) const { return scene.mean_of_image(image); }
    static void fields(auto& self, auto& visitor) {
        visitor.image(self.image);
        visitor.flag("bilinear", self.bilinear);
        visitor.choice("wrap mode", self.wrap_u, Wrap::one);
        visitor.choice("wrap mode", self.wrap_v, Wrap::one);
        visitor.coordinates(self.uv);
    }
};

}  // namespace treefarm
