// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>

namespace treefarm {

/// Constants that were tuned on scenes instead of derived, here and beside each decision of common/decide.
/// docs/generated/policy.md lists all, and a render records them in resolved.toml. This header includes no other of the
/// project, so that every module may include it.
namespace policy {

struct Constant {
    const char* name;  ///< with its group: "guiding.giving_up"
    double value;
    const char* meaning;           ///< with the unit
    const char* evidence;          ///< a publication, or a page of bench/log
    const char* sensitivity = "";  ///< work at half and at twice the value, over that with it (date of measurement)
};

inline constexpr const char* kRoulette = "bench/log/splitting-and-roulette.md";
inline constexpr const char* kTree = "bench/log/guiding.md";
inline constexpr const char* kViews = "bench/log/guiding.md#what-do-views-bring";
inline constexpr const char* kLights = "bench/log/next-event.md#emitters-by-power-or-as-learned";
inline constexpr const char* kError = "bench/log/error.md";
inline constexpr const char* kProgram2017 = "the program of Mueller et al. 2017";
inline constexpr const char* kProgram2019 = "the program of Mueller et al. 2019";
inline constexpr const char* kDecisions = "bench/log/decisions.md#does-next-event-by-region-pay";
inline constexpr const char* kJoint = "bench/log/decisions.md#why-did-classroom-lose";
inline constexpr const char* kRare = "bench/log/decisions.md#what-does-a-light-sample-cost";

/// Table of the constants that are for no decision of common/decide, grouped by what they are for.
inline constexpr Constant kConstants[] = {
    // Russian roulette, candidates, and glass seen by the camera.
    {"walk.adjoint_window", 4.0,
     "a path plays roulette when it is expected to carry less than one part in so many of what its first vertex does",
     kRoulette, "0.99, 1.02 (2026-11-26)"},
    {"walk.adjoint_least", 0.5, "least probability to survive it", kRoulette},
    {"walk.adjoint_most", 0.95, "greatest probability to survive it", kRoulette},
    {"walk.unguided_window", 2.0, "unguided paths survive with this times their throughput", kDecisions},
    {"walk.unguided_most", 0.95, "the same of unguided paths, by throughput", "Mitsuba 0.6",
     "0.98, 1.13 (2026-11-26, before unguided_window)"},
    {"walk.untrained_least", 0.1, "least probability to survive before the first tree", kProgram2017},
    {"walk.guided_survival", 0.99,
     "probability to survive by guiding.roulette = \"constant\", and at most before the first tree", kProgram2017},
    {"walk.candidate_fair", 0.2, "least share of a candidate direction in what is taken, times their number",
     "bench/log/guiding.md#one-direction-a-vertex-or-several", "1.00, 1.00 (2026-11-26)"},
    {"walk.split_often", 4.0, "glass before the camera: the other way is followed with so many times its weight",
     "bench/log/splitting-and-roulette.md#glass-before-the-camera-toss-or-split"},
    // Learning and growth of the tree.
    {"learning.spatial_threshold", 2000.0,
     "c of the spatial split rule for 512 x 512 pixels, in proportion to their fourth root", kTree,
     "0.97, 1.03 (2026-11-26)"},
    {"learning.product_cells", 0.5, "cells of views that learn products, over those of all regions", kViews,
     "1.00, 1.00 (2026-11-26)"},
    {"learning.free_cells", 65536, "as many cells of views are never too many", kViews},
    {"learning.least_use", 0.5, "of a region's cells, what is left where the BSDF is sampled instead", kTree},
    {"learning.lights_unlearned", 0.2,
     "what stays of the choice of emitters without what is learned: one that was never seen may be seen yet", kLights,
     "0.97, 1.05 (2026-11-26, as lights_by_power, before the light tree)"},
    {"learning.lights_prior_vertices", 128.0, "the parent's choice of emitters counts as much as so many vertices",
     kLights},
    {"learning.least_bsdf_fraction", 0.05, "never 0: where the tree has seen nothing the BSDF alone reaches everything",
     kTree},
    {"learning.mixture_prior_records", 64.0, "the parent's BSDF fraction counts as much as so many average records",
     kTree, "0.99, 0.99 (2026-11-26)"},
    {"learning.idle_fraction", 0.05,
     "a region's views are released where all of them deserve less than this share of the samples", kViews},
    {"learning.idle_passes", 2, "so many passes in a row", kViews},
    {"learning.least_view_gain", 0.1, "or gain less than this, nats per record", kViews},
    {"learning.least_view_gain_of_all", 0.015,
     "all views are released where together they gain less than this, nats per record of the whole tree", kViews},
    {"learning.initial_depth", 4,
     "depth of a region's quadtree before anything is known: where the rule \"more than 1 % of the energy\" ends for "
     "even light",
     "Mueller et al. 2017, section 3.2"},
    // Lengths of passes, and which of them count.
    {"schedule.kickstart_spp", 128,
     "kick-start samples emitters directly in passes that begin with fewer samples per pixel", kProgram2017,
     "1.00, 1.00 (2026-11-26)"},
    {"schedule.teaching_share", 3.0,
     "an open budget's pass teaches while at least so many times its samples are still to be rendered", kError},
    {"schedule.least_weighed_spp", 4, "shorter passes know too little of their own variance to be weighed by it",
     kProgram2019},
    {"schedule.kickstart_weight", 0.5,
     "weight of each record of a kick-start pass, in which light samples are records, too", kProgram2019},
    // End of renders with a budget of seconds or error.
    {"budget.time_tolerance", 0.05, "how far a render may be from budget.seconds, share of it", kError},
    {"budget.least_tolerance", 1.0, "but not less than so many seconds ...", kError},
    {"budget.most_tolerance", 0.1, "... as long as that is no more than this share", kError},
    {"budget.hedge", 0.7,
     "share of the time left that an ending pass takes, so that a wrong forecast can be made up for", kError},
    {"budget.probe", 0.07, "share of the time left that a strict render tries its last tree for, thrown away", kError},
    {"budget.spp_to_believe", 16, "samples from which on an estimated error may end a render", kError},
    {"budget.spp_to_believe_zero", 64, "the same of an error of zero", kError},
    {"budget.least_share", 1.0 / 16,
     "a pass that makes up for a missed target renders at least this share of what there is", kError},
    {"budget.error_margin", 1.02, "passes that end for an error have so many times the samples needed", kError},
    {"budget.strict_error_margin", 1.10, "the same of a strict render", kError},
    // Progress expected from further trees.
    {"forecast.learned", 0.55, "after two trees that brought the variance below this share, a forecast is a bound",
     kError},
    {"forecast.noisy", 0.1,
     "half the width of the error's own interval, relative, above which it is too noisy to forecast by", kError},
    {"forecast.far", 16.0, "more than so many times the samples done is too far ahead", kError},
    {"forecast.fading", 0.75, "progress from one tree to the next is the progress before to this power", kError},
    {"forecast.cost_fading", 0.35, "the same of what a sample costs", kError},
    {"forecast.least_progress", 0.25, "no tree is trusted to bring the variance below this share", kError},
    {"forecast.most_cost_ratio", 1.6, "nor to change a sample's cost by more", kError},
    {"forecast.trees_at_rest", 3, "so many trees that are no better than each other have learned all", kError},
    {"forecast.recording_share", 0.12, "what keeping records takes of tracing; 6 to 23 % on eight scenes", kError},
};

}  // namespace policy

/// Value of a constant of a table. An unknown name does not compile, nor does an integer type for a fraction.
template <const auto& kTable, class Number = double>
consteval Number tuned(const char* name) {
    for (const policy::Constant& constant : kTable) {
        const char *a = constant.name, *b = name;
        while (*a != 0 && *a == *b)
            ++a, ++b;
        if (*a != *b) continue;
        const auto value = static_cast<Number>(constant.value);
        if (!std::floating_point<Number> && static_cast<double>(value) != constant.value) throw "it is no integer";
        return value;
    }
    throw "there is no such constant";
}

/// Value of a constant of policy::kConstants.
template <class Number = double>
consteval Number tuned(const char* name) {
    return tuned<policy::kConstants, Number>(name);
}

}  // namespace treefarm
