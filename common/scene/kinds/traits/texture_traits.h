// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/math/vec.h"
#include "common/scene/kinds/traits/kind_effect.h"
#include "common/scene/kinds/traits/texture_image.h"

namespace treefarm {

/// Affine transform of texture coordinates before look-up: (u, v) -> (u_row . (u, v, 1), v_row . (u, v, 1)).
struct UvTransform {
    Vec3 u_row{1.0f, 0.0f, 0.0f};
    Vec3 v_row{0.0f, 1.0f, 0.0f};
    bool operator==(const UvTransform&) const = default;
};

/// Limits of the values of an image or a texture.
struct ValueRange {
    float min = 0.0f, max = 0.0f;

    /// Smallest range that contains this one and the value.
    ValueRange with(float value) const { return {value < min ? value : min, max < value ? value : max}; }
};

/// Range of the channels of two colours.
inline ValueRange range_of_colors(const Rgb& a, const Rgb& b) {
    ValueRange range{a.x, a.x};
    for (const Rgb& color : {a, b})
        for (int i = 0; i < 3; ++i)
            range = range.with(color[i]);
    return range;
}

}  // namespace treefarm
