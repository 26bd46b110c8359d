#pragma once

#include <cstdint>
#include <vector>

#include "common/config/job.h"
#include "common/guiding/sd_tree.h"
#include "common/guiding/tree_update.h"

namespace treefarm {

struct RefineSettings {
    double spatial_threshold =
        0;  ///< records (weighted) above which a region splits: c sqrt(n_k / 4), n_k spp of the coming pass
    std::uint32_t directional_divisor = 100;  ///< a cell splits while divisor * sum > total
    double record_weight = 1.0;               ///< of each record of the pass: 0.5 in kick-start passes
    GuidingTarget target = GuidingTarget::radiance;
};

/// Where a region of the refined tree comes from: the region of the old tree, halved so many times.
struct RegionOrigin {
    std::uint32_t region = 0;
    int halvings = 0;
};

struct RefineReport {
    std::uint64_t spatial_depth_capped = 0;      ///< regions that would have split beyond kMaxSpatialDepth
    std::uint64_t directional_depth_capped = 0;  ///< cells that would have split beyond kMaxDirectionDepth
    std::uint64_t memory_capped = 0;             ///< regions that would have split beyond 2^31 cells
    int spatial_depth = 0;
    int directional_depth = 0;
    double mean_cells = 0;              ///< per region
    std::vector<RegionOrigin> origins;  ///< per region of the refined tree
};

/// The next tree: spatial splits by record count, directional splits and prunings by energy, densities re-expressed on
/// the new topology (a split cell gives a quarter to each child, pruned cells are summed). Pure and deterministic.
/// Source: Mueller et al. 2017, section 3.3, with the thresholds as their program has them.
SdTree refine(const SdTree& tree, const TreeSums& sums, const RefineSettings& settings, RefineReport& report);

}  // namespace treefarm
