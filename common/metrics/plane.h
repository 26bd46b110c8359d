// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace treefarm {

/// One value per pixel, row by row from the top.
struct Plane {
    int width = 0;   ///< pixels
    int height = 0;  ///< pixels
    std::vector<float> values;

    Plane() = default;
    Plane(int w, int h)
        : width(w), height(h), values(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), 0.0f) {}

    std::span<const float> row(int y) const {
        return std::span(values).subspan(static_cast<std::size_t>(y) * static_cast<std::size_t>(width),
                                         static_cast<std::size_t>(width));
    }
    std::span<float> row(int y) {
        return std::span(values).subspan(static_cast<std::size_t>(y) * static_cast<std::size_t>(width),
                                         static_cast<std::size_t>(width));
    }
};

}  // namespace treefarm
