// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/guiding/regions/model_statistics.h"
#include "common/guiding/sd_tree/sd_tree.h"

namespace treefarm {

/// Statistics of a tree, without its bytes.
TreeStatistics tree_statistics(const SdTree& tree);

/// Number of cells per region: the region's own, and its part of the cells of a shared T2.
std::vector<double> cells_by_region(const SdTree& tree);

/// Mean density of a distribution over directions, per square of a grid of 2^bits by 2^bits squares of the direction
/// square (direction_map.h), in row order from v = 0. Per steradian, so the mean over squares is 1 / (4 pi). Exact.
std::vector<float> density_map(const SdTree& tree, std::uint32_t distribution, int bits);

}  // namespace treefarm
