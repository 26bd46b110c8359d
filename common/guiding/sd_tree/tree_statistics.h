// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/guiding/regions/model_statistics.h"
#include "common/guiding/sd_tree/sd_tree.h"

namespace treefarm {

/// Figures of a tree, without its bytes.
TreeStatistics tree_statistics(const SdTree& tree);

/// Cells that a region answers for: its own, and its part of those of a T2 that it shares with others.
std::vector<double> cells_by_region(const SdTree& tree);

/// A distribution over directions averaged over the squares of a grid of 2^bits by 2^bits on the direction square
/// (direction_map.h), in row order from v = 0: per steradian, so that the mean is 1 / (4 pi). Exact.
std::vector<float> density_map(const SdTree& tree, std::uint32_t distribution, int bits);

}  // namespace treefarm
