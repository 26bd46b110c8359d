// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace treefarm {

/// The sRGB transfer function and its inverse (IEC 61966-2-1), on [0, 1].
inline float srgb_encode(float linear) {
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}
inline float srgb_decode(float encoded) {
    return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

}  // namespace treefarm
