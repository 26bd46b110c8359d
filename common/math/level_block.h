// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace treefarm {

/// Side of the blocks of pixels by whose light noise is judged.
inline constexpr std::size_t kLevelBlock = 8;

/// Index of the block of pixels that (x, y) lies in, for an image with `columns` blocks per row. Noise is judged
/// relative to the mean light of a block.
inline std::size_t level_block(std::size_t x, std::size_t y, std::size_t columns) {
    return y / kLevelBlock * columns + x / kLevelBlock;
}

}  // namespace treefarm
