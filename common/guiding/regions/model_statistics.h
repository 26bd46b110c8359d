// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "common/guiding/regions/first_model.h"

namespace treefarm {

/// Quantiles of some numbers: the q-quantile is the smallest number that at least a share q of them does not exceed.
/// All 0 if there are no numbers.
struct Quantiles {
    std::size_t count = 0;
    double mean = 0, least = 0, tenth = 0, median = 0, nine_tenths = 0, most = 0;
};
Quantiles quantiles_of(std::vector<double> values);

/// Quantiles of the probabilities of sampling the BSDF, the region's distribution (T1) and the view's (T2), which sum
/// to one.
struct MixtureQuantiles {
    Quantiles bsdf, t1, t2;
};

/// Numbers per depth, from depth 0.
using DepthCounts = std::vector<std::uint32_t>;

/// Statistics of a guide's model. All regions, views and cells have equal weight, whatever their size and use.
struct TreeStatistics {
    std::uint32_t pass = 0;  ///< number of the pass that it guides
    bool trained = false;
    std::uint32_t nodes = 0, regions = 0, t2s = 0, views = 0;
    std::uint32_t regions_with_t2 = 0;
    std::uint64_t region_cells = 0, view_cells = 0;
    DepthCounts region_depth;       ///< halvings of space
    DepthCounts region_cell_depth;  ///< quarterings of the direction square, for cells of T1
    DepthCounts view_depth;         ///< of outgoing directions
    DepthCounts view_cell_depth;    ///< for cells of T2
    Quantiles cells_per_region, cells_per_view, views_per_t2;
    MixtureQuantiles regions_mixture;  ///< without a T2, a_T2 = 0
    MixtureQuantiles views_mixture;
    std::uint64_t encoded_bytes = 0;  ///< size as sent and stored
    std::uint64_t memory_bytes = 0;   ///< size in the form that workers sample from

    double t2_share() const { return regions == 0 ? 0.0 : static_cast<double>(regions_with_t2) / regions; }
};
/// Increments the count of this depth.
void count_depth(DepthCounts& counts, std::size_t depth);

/// Statistics of a guide's regions, without cells, views and bytes.
TreeStatistics region_statistics(const RegionModel& model);
/// Statistics, without bytes, of a guide with equal cells and equally many in each region; `size`: its total.
TreeStatistics even_statistics(const RegionModel& model, const ModelFigures& size);

}  // namespace treefarm
