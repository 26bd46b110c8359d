// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "common/decide/next_event/next_event_choice.h"
#include "common/guiding/statistics/settings.h"

namespace treefarm {

/// Settings of learning between passes; each guide uses those that apply to it.
struct RefineSettings {
    double spatial_threshold =
        0;  ///< weighted records above which a region splits: c sqrt(n_k / 4), n_k spp of the next pass
    std::uint32_t directional_divisor = 100;  ///< a cell splits while divisor * sum > total
    double least_use = 1.0;  ///< a region's divisor is scaled by twice the probability of sampling its tree, but by no
                             ///< less than this, (0, 1]; 1: never scaled
    double record_weight = 1.0;  ///< of each record of the pass: 0.5 in kick-start passes
    GuidingTarget target = GuidingTarget::radiance;
    double view_threshold = 0;        ///< weighted records above which a view splits, once
    double view_set_threshold = 0;    ///< weighted records above which a T2 of several regions is cut in space
    bool last_update = false;         ///< last learning step: distributions that are of no use now can be dropped
    bool with_flux = false;           ///< regions learn their flux
    bool views_record_alone = false;  ///< records of views are not in the counts of their regions
    double view_cells = std::numeric_limits<double>::infinity();  ///< greatest number of T2 cells per T1 cell
    double least_view_cells = 0;  ///< number of T2 cells up to which view_cells does not apply
    NextEventPrice next_event{};
};

/// Origin of a region of the refined tree: a region of the old tree, and the number of halvings since.
struct RegionOrigin {
    std::uint32_t region = 0;
    int halvings = 0;
};

/// Origin of a view of the refined tree: a view of the old tree, and the number of halvings of its evidence.
struct ViewOrigin {
    std::uint32_t view = 0;
    int halvings = 0;
};

/// Outcome of a refinement, for reports and for the learners per region.
struct RefineReport {
    std::uint64_t spatial_depth_capped = 0;      ///< regions that would have split beyond kMaxSpatialDepth
    std::uint64_t directional_depth_capped = 0;  ///< cells that would have split beyond kMaxDirectionDepth
    std::uint64_t memory_capped = 0;             ///< regions that would have split beyond 2^31 cells
    int spatial_depth = 0;
    int directional_depth = 0;
    double mean_cells = 0;           ///< per region
    std::uint64_t views_capped = 0;  ///< views that would have split beyond kMaxViewDepth or RefineSettings::view_cells
    NextEventVerdict next_event{};
    std::vector<RegionOrigin> origins;     ///< per region of the refined tree
    std::vector<ViewOrigin> view_origins;  ///< per view of the refined tree
};

}  // namespace treefarm
