// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace treefarm {

/// A refined directional quadtree, cells in Z-order.
struct RefinedDirections {
    std::vector<std::uint8_t> depth;
    std::vector<std::uint32_t> mass;  ///< probabilities times 2^kMassBits
    int max_depth = 0;
    std::uint64_t depth_capped = 0;  ///< cells that would have split beyond kMaxDirectionDepth
};

/// The next quadtree: a cell splits while divisor * sum > total, and its children are merged otherwise. Densities are
/// transferred to the new topology (a split cell gives a quarter to each child, merged cells are summed). `depth` and
/// `sum` are per cell, in Z-order.
RefinedDirections refine_directions(std::span<const std::uint8_t> depth, std::span<const std::uint64_t> sum,
                                    std::uint32_t divisor);

/// Converts a cell's second moment, an integral over the cell, into the quantity to sample in proportion to: variance
/// is least for probabilities proportional to sqrt(moment * area).
std::uint64_t deviation(std::uint64_t moment, std::uint8_t depth);

}  // namespace treefarm
