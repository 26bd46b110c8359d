// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "common/base/policy.h"

namespace treefarm {

/// Number of the block of pixels about (x, y), by whose light noise is judged, in an image with rows of `columns`
/// blocks.
inline std::size_t level_block(std::size_t x, std::size_t y, std::size_t columns) {
    return y / kPolicy.levels.block * columns + x / kPolicy.levels.block;
}

}  // namespace treefarm
