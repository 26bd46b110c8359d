// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "common/guiding/statistics/settings.h"

namespace treefarm {

/// Factor by which evidence of emitters, next event, mixtures and visits loses weight with each pass: that of a coarser
/// model goes out of date.
inline constexpr double kKeptEvidence = 0.5;

/// What a pass costs and how noisy it is: by these a decision on next event weighs noise against rays.
struct NextEventPrice {
    double variance = 0;  ///< of a camera sample, relative to the square of its block's light
    double rays = 0;      ///< of a camera sample, in closest-hit rays; at 0 nothing is decided
    double paths = 0;     ///< camera samples of the pass
};

/// What was decided on next event: variance times cost over that of one sample at every vertex, both as predicted; and
/// how often emitters are sampled.
struct NextEventVerdict {
    double saved = 1;  ///< 1 where nothing is decided
    double low = 0;    ///< part of the vertices with the least samples
};

/// How a guide learns between passes; each takes of it what it has.
struct RefineSettings {
    double spatial_threshold =
        0;  ///< records (weighted) above which a region splits: c sqrt(n_k / 4), n_k spp of the coming pass
    std::uint32_t directional_divisor = 100;  ///< a cell splits while divisor * sum > total
    double least_use = 1.0;      ///< a region's divisor shrinks with twice the probability of sampling its tree, but at
                                 ///< most to this part, (0, 1]; 1: never
    double record_weight = 1.0;  ///< of each record of the pass: 0.5 in kick-start passes
    GuidingTarget target = GuidingTarget::radiance;
    double view_threshold = 0;        ///< records (weighted) above which a view splits, once
    double view_set_threshold = 0;    ///< records (weighted) above which a T2 of several regions is cut in space
    bool last_update = false;         ///< nothing will be learned any more: what is of no use now never will be
    bool with_flux = false;           ///< regions learn their flux
    bool views_record_alone = false;  ///< what views recorded is missing in their regions' counts
    double view_cells = std::numeric_limits<double>::infinity();  ///< at most so many of T2 for each of T1,
    double least_view_cells = 0;                                  ///< unless they are fewer than this
    NextEventPrice next_event{};
};

/// Where a region of the refined tree comes from: the region of the old tree, halved so many times.
struct RegionOrigin {
    std::uint32_t region = 0;
    int halvings = 0;
};

/// Where a view of the refined tree comes from: the view of the old tree, its evidence halved so many times.
struct ViewOrigin {
    std::uint32_t view = 0;
    int halvings = 0;
};

/// What became of it, for the report and for what is learned per region.
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
