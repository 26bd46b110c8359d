// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "common/guiding/regions/first_model.h"

namespace treefarm {

/// How some numbers are spread: a quantile is the smallest of them that at least its share of them does not exceed.
/// All 0 without numbers.
struct Quantiles {
    std::size_t count = 0;
    double mean = 0, least = 0, tenth = 0, median = 0, nine_tenths = 0, most = 0;
};
Quantiles quantiles_of(std::vector<double> values);

/// Probabilities of sampling the BSDF, the region's distribution (T1) and the view's (T2): they sum to one.
struct MixtureQuantiles {
    Quantiles bsdf, t1, t2;
};

/// Counts per depth, from depth 0.
using DepthCounts = std::vector<std::uint32_t>;

/// Figures of a guide's model. Every region, view and cell counts the same, whatever its size and however often it is
/// seen.
struct TreeStatistics {
    std::uint32_t pass = 0;  ///< that it guides
    bool trained = false;
    std::uint32_t nodes = 0, regions = 0, t2s = 0, views = 0;
    std::uint32_t regions_with_t2 = 0;
    std::uint64_t region_cells = 0, view_cells = 0;
    DepthCounts region_depth;       ///< halvings of space
    DepthCounts region_cell_depth;  ///< quarterings of the direction square, of T1s' cells
    DepthCounts view_depth;         ///< of outgoing directions
    DepthCounts view_cell_depth;    ///< of T2s' cells
    Quantiles cells_per_region, cells_per_view, views_per_t2;
    MixtureQuantiles regions_mixture;  ///< where no T2 is used: a_T2 = 0
    MixtureQuantiles views_mixture;
    std::uint64_t encoded_bytes = 0;  ///< as it is sent and stored
    std::uint64_t memory_bytes = 0;   ///< as it is sampled from

    double t2_share() const { return regions == 0 ? 0.0 : static_cast<double>(regions_with_t2) / regions; }
};
/// Adds to the counts one at this depth.
void count_depth(DepthCounts& counts, std::size_t depth);

/// What a guide's regions are like, without cells, views and bytes.
TreeStatistics region_statistics(const RegionModel& model);
/// Statistics, without bytes, of a guide that has no more to tell than its `size`: cells alike, the same number in all
/// regions.
TreeStatistics even_statistics(const RegionModel& model, const ModelFigures& size);

}  // namespace treefarm
