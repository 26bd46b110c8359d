// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace treefarm {

/// Side of the blocks of pixels by whose light noise is judged.
inline constexpr std::size_t kLevelBlock = 8;

/// Number of the block of pixels about (x, y), by whose light noise is judged, in an image with rows of `columns`
/// blocks.
inline std::size_t level_block(std::size_t x, std::size_t y, std::size_t columns) {
    return y / kLevelBlock * columns + x / kLevelBlock;
}

}  // namespace treefarm
