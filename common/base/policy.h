// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>

namespace treefarm {

/// Constants that were tuned on scenes instead of derived. docs/generated/policy.md lists them, and a render records
/// them in resolved.toml. This header includes no other of the project, so that every module may include it.
namespace policy {

struct Constant {
    const char* name;  ///< with its group: "guiding.giving_up"
    double value;
    const char* meaning;           ///< with the unit
    const char* evidence;          ///< a publication, or a page of bench/log
    const char* sensitivity = "";  ///< work at half and at twice the value, over that with it (date of measurement)
};

inline constexpr const char* kAuto = "bench/log/decisions.md#when-is-guiding-given-up";
inline constexpr const char* kSplits = "bench/log/splitting-and-roulette.md";
inline constexpr const char* kRoulette = "bench/log/splitting-and-roulette.md";
inline constexpr const char* kTree = "bench/log/guiding.md";
inline constexpr const char* kViews = "bench/log/guiding.md#what-do-views-bring";
inline constexpr const char* kLights = "bench/log/next-event.md#emitters-by-power-or-as-learned";
inline constexpr const char* kError = "bench/log/error.md";
inline constexpr const char* kProgram2017 = "the program of Mueller et al. 2017";
inline constexpr const char* kProgram2019 = "the program of Mueller et al. 2019";
inline constexpr const char* kDecisions = "bench/log/decisions.md#does-next-event-by-region-pay";
inline constexpr const char* kJoint = "bench/log/decisions.md#why-did-classroom-lose";
inline constexpr const char* kEnds = "bench/log/bidirectional.md#when-should-light-subpaths-be-given-up";
inline constexpr const char* kMissed = "bench/log/bidirectional.md";
inline constexpr const char* kRare = "bench/log/decisions.md#what-does-a-light-sample-cost";
inline constexpr const char* kHeld = "bench/log/decisions.md#does-auto-hold-in-scenes-that-nobody-tuned-it-on";

/// Table of all constants, grouped by the decision that they are for.
inline constexpr Constant kConstants[] = {
    // Whether paths are guided ("auto"), judged by what guided samples estimate for unguided ones.
    {"guiding.least_judged_spp", 4, "shorter passes have no say, spp", kAuto},
    {"guiding.ray_cost", 1.4,
     "cost of a guided ray over that of an unguided one, training included; 1.24 to 1.53 by scene", kAuto,
     "0.98, 1.19 (2026-11-28)"},
    {"guiding.mistrusted", 2.0,
     "unguided passes that are so many times as noisy as guided samples have said are believed instead", kDecisions,
     "1.00, 1.00 (2026-11-28)"},
    {"guiding.giving_up", 0.85,
     "paths are unguided where variance times cost of unguided samples over that of guided ones is below this", kHeld,
     "0.96, 0.98 (2026-11-28)"},
    {"guiding.giving_up_early", 0.75,
     "the same after passes of at most least_settled_spp; between those and settled_spp by the logarithm", kJoint},
    {"guiding.giving_up_errors", 1.3, "by so many standard errors", kDecisions, "1.00, 0.96 (2026-11-28)"},
    {"guiding.taking_up", 1.1, "and guided again where it is above this", kDecisions, "1.00, 1.00 (2026-11-28)"},
    {"guiding.least_settled_spp", 16, "trees of shorter passes still get much better, spp", kDecisions},
    {"guiding.settled_spp", 64, "from passes of so many spp on giving_up holds", kHeld},
    {"guiding.least_known", 4.0, "noise that rests on fewer groups of pixels, of 64, has no say", kDecisions},
    // Share of vertices at which next event samples emitters ("auto").
    {"next_event.counted_every", 8,
     "direct light is summed along one of so many samples of a pixel; along all of them it would take 17 % of the time",
     kDecisions},
    {"next_event.least_vertices", 512.0, "nothing is decided from fewer, of all regions together", kDecisions},
    {"next_event.lent_vertices", 256.0,
     "what is known of the cube about a region counts as so many vertices of its own", kDecisions,
     "1.00, 1.00 (2026-11-28)"},
    {"next_event.standard_errors", 2.0, "by how many standard errors fewer light samples must win", kDecisions,
     "0.99, 1.02 (2026-11-28)"},
    {"next_event.least_gain", 0.03, "and by this share of the region's own noise and cost", kDecisions,
     "1.00, 1.00 (2026-11-28)"},
    {"next_event.learned", 0.1,
     "part of a guided region's noise and cost that trees are expected to take away with each step to fewer light "
     "samples, which they learn",
     kJoint, "1.02, 0.99 (2026-11-28)"},
    {"next_event.sample_cost", 0.25, "cost of a light sample without its ray, in rays", kRare,
     "1.01, 0.99 (2026-11-28)"},
    {"next_event.shadow_ray_cost", 1.0, "cost of a shadow ray and its weights, in rays", kRare},
    // Light level around a pixel, in relation to which noise is measured.
    {"levels.least", 0.1, "darker blocks count as bright as this share of the image's mean", kDecisions},
    // Splitting: number of paths that one splits into, and when splitting is given up.
    {"splitting.usual", 8, "as how many paths one may go on (guiding.splitting = 0)", kSplits,
     "1.00, 0.99 (2026-11-26)"},
    {"splitting.least_share", 1.4,
     "of what the first vertex sends to the camera, what each path of a split is expected to carry at least", kSplits,
     "1.00, 0.98 (2026-11-26)"},
    {"splitting.least_quietened", 1.01, "splitting ends where samples are not at least so many times quieter", kSplits},
    {"splitting.least_found", 0.99, "passes whose unsplit samples find less of the light have no say", kSplits},
    {"splitting.least_spp", 16, "nor have shorter ones, spp", kSplits},
    {"splitting.least_gain", 0.97, "it may cost a little more than it shows: whole renders gain more", kSplits},
    {"splitting.least_gain_alone", 0.9, "the same without next event, where they gain most", kSplits},
    {"splitting.shown_gain", 2.2,
     "with next event the gain that is seen is so many times what renders gain that never split", kSplits},
    {"splitting.copy_ray_cost", 1.4, "cost of a copy's ray over that of another", kSplits},
    // Light subpaths of bidirectional samples: when they are given up, and which emitters they start from.
    {"light_subpaths.ray_cost", 1.7,
     "cost of a ray of a bidirectional sample over that of a path from the camera, connections included", kEnds},
    {"light_subpaths.least_gain", 0.9,
     "light subpaths are given up where samples without them have less than this times their variance at equal cost",
     kEnds},
    {"light_subpaths.least_found", 0.95, "but not where those find less of the light: nobody knows how noisy they are",
     kEnds},
    {"light_subpaths.least_spp", 4, "shorter passes have no say, spp", kEnds},
    {"light_subpaths.most_of_mean", 32.0,
     "what a sample brings is compared up to so many times the usual: a firefly that both kinds meet hides what else "
     "differs",
     kMissed},
    {"light_subpaths.missed_errors", 1.0,
     "light that samples without them have missed is noise where it is more than so many standard errors", kRare},
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

/// Value of a constant. An unknown name does not compile, nor does an integer type for a fraction.
template <class Number = double>
consteval Number tuned(const char* name) {
    for (const policy::Constant& constant : policy::kConstants) {
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

}  // namespace treefarm
