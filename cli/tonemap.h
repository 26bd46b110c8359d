// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <optional>
#include <string>

#include "common/math/vec.h"

namespace treefarm {

/// Map from linear radiance to values of a screen.
enum class ToneMap {
    srgb,      ///< unchanged, up to 1
    aces,      ///< per channel, Narkowicz' fit (2015, "ACES filmic tone mapping curve"), as published
    reinhard,  ///< L / (1 + L) of the luminance (Reinhard et al. 2002, equation 3), colours kept
};

inline std::optional<ToneMap> find_tone_map(const std::string& name) {
    if (name == "srgb") return ToneMap::srgb;
    if (name == "aces") return ToneMap::aces;
    if (name == "reinhard") return ToneMap::reinhard;
    return std::nullopt;
}

/// Linear colour for the screen, each channel in [0, 1], before the sRGB curve. Negative values and NaN become 0.
inline Rgb tone_mapped(ToneMap map, const Rgb& radiance) {
    constexpr float kMost = 1e15f;  // its square is finite
    Rgb c;
    for (int i = 0; i < 3; ++i)
        c[i] = radiance[i] > 0.0f ? std::min(radiance[i], kMost) : 0.0f;
    if (map == ToneMap::reinhard) c *= 1.0f / (1.0f + luminance(c));
    if (map == ToneMap::aces)
        for (int i = 0; i < 3; ++i)
            c[i] = c[i] * (2.51f * c[i] + 0.03f) / (c[i] * (2.43f * c[i] + 0.59f) + 0.14f);
    for (int i = 0; i < 3; ++i)
        c[i] = std::min(c[i], 1.0f);
    return c;
}

}  // namespace treefarm
