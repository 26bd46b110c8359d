// SPDX-License-Identifier: Apache-2.0
#include "common/plan/resolve/policy_table.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <type_traits>
#include <vector>

#include "common/base/policy.h"
#include "common/base/text/parse_text.h"

namespace treefarm {
namespace {

constexpr const char* kAuto = "bench/log/2026-11-25-auto.md";
constexpr const char* kSplits = "bench/log/2026-11-25-splitting.md";
constexpr const char* kRoulette = "bench/log/2026-11-25-roulette.md";
constexpr const char* kTree = "bench/log/2026-11-25-tree.md";
constexpr const char* kViews = "bench/log/2026-11-25-views.md";
constexpr const char* kLights = "bench/log/2026-11-25-emitters.md";
constexpr const char* kBudgets = "bench/log/2026-11-25-error.md";
constexpr const char* kError = "bench/log/2026-11-25-error.md";
constexpr const char* kProgram2017 = "the program of Mueller et al. 2017";
constexpr const char* kProgram2019 = "the program of Mueller et al. 2019";
constexpr const char* kDecisions = "bench/log/2026-11-27-decisions.md";
constexpr const char* kJoint = "bench/log/2026-11-27-joint.md";
constexpr const char* kEnds = "bench/log/2026-11-27-ends.md";
constexpr const char* kMissed = "bench/log/2026-11-27-missed-light.md";
constexpr const char* kRare = "bench/log/2026-11-27-rare-light.md";
constexpr const char* kHeld = "bench/log/2026-11-28-held-out.md";
constexpr const char* kGuess = "chosen, not measured";

constexpr Policy::Guiding kGuiding = kPolicy.guiding;
constexpr Policy::NextEvent kNextEvent = kPolicy.next_event;
constexpr Policy::Levels kLevels = kPolicy.levels;
constexpr Policy::Splitting kSplitting = kPolicy.splitting;
constexpr Policy::LightSubpaths kLightSubpaths = kPolicy.light_subpaths;
constexpr Policy::Walk kWalk = kPolicy.walk;
constexpr Policy::Learning kLearning = kPolicy.learning;
constexpr Policy::Grids kGrids = kPolicy.grids;
constexpr Policy::Lights kLamps = kPolicy.lights;
constexpr Policy::Splats kSplats = kPolicy.splats;
constexpr Policy::Schedule kSchedule = kPolicy.schedule;
constexpr Policy::Farm kFarm = kPolicy.farm;
constexpr Policy::Budget kBudget = kPolicy.budget;
constexpr Policy::Forecast kForecast = kPolicy.forecast;
constexpr Policy::Tails kTails = kPolicy.tails;

template <class Number>
constexpr PolicyEntry entry(const char* name, Number value, const char* meaning, const char* evidence) {
    return {name, static_cast<double>(value), std::is_same_v<Number, float>, meaning, evidence};
}

constexpr std::array kEntries = {
    entry("guiding.least_judged_spp", kGuiding.least_judged_spp, "shorter passes have no say, spp", kAuto),
    entry("guiding.ray_cost", kGuiding.ray_cost,
          "cost of a guided ray over that of an unguided one, training included; 1.24 to 1.53 by scene", kAuto),
    entry("guiding.mistrusted", kGuiding.mistrusted,
          "unguided passes that are so many times as noisy as guided samples have said are believed instead",
          kDecisions),
    entry("guiding.giving_up", kGuiding.giving_up,
          "paths are unguided where variance times cost of unguided samples over that of guided ones is below this",
          kHeld),
    entry("guiding.giving_up_early", kGuiding.giving_up_early,
          "the same after passes of at most least_settled_spp; between those and settled_spp by the logarithm", kJoint),
    entry("guiding.giving_up_errors", kGuiding.giving_up_errors, "by so many standard errors", kDecisions),
    entry("guiding.taking_up", kGuiding.taking_up, "and guided again where it is above this", kDecisions),
    entry("guiding.least_settled_spp", kGuiding.least_settled_spp, "trees of shorter passes still get much better, spp",
          kDecisions),
    entry("guiding.settled_spp", kGuiding.settled_spp, "from passes of so many spp on giving_up holds", kHeld),
    entry("guiding.least_known", kGuiding.least_known, "noise that rests on fewer groups of pixels, of 64, has no say",
          kDecisions),
    entry("next_event.counted_every", kNextEvent.counted_every,
          "direct light is summed along one of so many samples of a pixel; along all of them it would take 17 % of the "
          "time",
          kDecisions),
    entry("next_event.least_vertices", kNextEvent.least_vertices,
          "nothing is decided from fewer, of all regions together", kDecisions),
    entry("next_event.lent_vertices", kNextEvent.lent_vertices,
          "what is known of the cube about a region counts as so many vertices of its own", kDecisions),
    entry("next_event.standard_errors", kNextEvent.standard_errors,
          "by how many standard errors fewer light samples must win", kDecisions),
    entry("next_event.least_gain", kNextEvent.least_gain, "and by this share of the region's own noise and cost",
          kDecisions),
    entry("next_event.learned", kNextEvent.learned,
          "part of a guided region's noise and cost that trees are expected to take away with each step to fewer light "
          "samples, which they learn",
          kJoint),
    entry("next_event.sample_cost", kNextEvent.sample_cost, "cost of a light sample without its ray, in rays", kRare),
    entry("next_event.shadow_ray_cost", kNextEvent.shadow_ray_cost, "cost of a shadow ray and its weights, in rays",
          kRare),
    entry("next_event.least_rest", kNextEvent.least_rest,
          "part of all noise or cost that no decision is believed to take away", kGuess),
    entry("levels.least", kLevels.least, "darker blocks count as bright as this share of the image's mean", kDecisions),
    entry("levels.block", kLevels.block, "side of the blocks that noise is relative to, pixels", kGuess),
    entry("splitting.usual", kSplitting.usual, "as how many paths one may go on (guiding.splitting = 0)", kSplits),
    entry("splitting.least_share", kSplitting.least_share,
          "of what the first vertex sends to the camera, what each path of a split is expected to carry at least",
          kSplits),
    entry("splitting.least_quietened", kSplitting.least_quietened,
          "splitting ends where samples are not at least so many times quieter", kSplits),
    entry("splitting.least_found", kSplitting.least_found,
          "passes whose unsplit samples find less of the light have no say", kSplits),
    entry("splitting.least_spp", kSplitting.least_spp, "nor have shorter ones, spp", kSplits),
    entry("splitting.least_gain", kSplitting.least_gain,
          "it may cost a little more than it shows: whole renders gain more", kSplits),
    entry("splitting.least_gain_alone", kSplitting.least_gain_alone,
          "the same without next event, where they gain most", kSplits),
    entry("splitting.shown_gain", kSplitting.shown_gain,
          "with next event the gain that is seen is so many times what renders gain that never split", kSplits),
    entry("splitting.copy_ray_cost", kSplitting.copy_ray_cost, "cost of a copy's ray over that of another", kSplits),
    entry("light_subpaths.ray_cost", kLightSubpaths.ray_cost,
          "cost of a ray of a bidirectional sample over that of a path from the camera, connections included", kEnds),
    entry("light_subpaths.least_gain", kLightSubpaths.least_gain,
          "light subpaths are given up where samples without them have less than this times their variance at equal "
          "cost",
          kEnds),
    entry("light_subpaths.least_found", kLightSubpaths.least_found,
          "but not where those find less of the light: nobody knows how noisy they are", kEnds),
    entry("light_subpaths.least_spp", kLightSubpaths.least_spp, "shorter passes have no say, spp", kEnds),
    entry("light_subpaths.most_of_mean", kLightSubpaths.most_of_mean,
          "what a sample brings is compared up to so many times the usual: a firefly that both kinds meet hides what "
          "else differs",
          kMissed),
    entry("light_subpaths.missed_errors", kLightSubpaths.missed_errors,
          "light that samples without them have missed is noise where it is more than so many standard errors", kRare),
    entry("light_subpaths.prior_paths", kLightSubpaths.prior_paths,
          "light paths of an emitter that count as if they had brought what all do", kGuess),
    entry("light_subpaths.unlearned", kLightSubpaths.unlearned,
          "part of the light paths that start by power whatever was learned", kGuess),
    entry("walk.adjoint_window", kWalk.adjoint_window,
          "a path plays roulette when it is expected to carry less than one part in so many of what its first vertex "
          "does",
          kRoulette),
    entry("walk.adjoint_least", kWalk.adjoint_least, "least probability to survive it", kRoulette),
    entry("walk.adjoint_most", kWalk.adjoint_most, "greatest probability to survive it", kRoulette),
    entry("walk.unguided_window", kWalk.unguided_window, "unguided paths survive with this times their throughput",
          kDecisions),
    entry("walk.unguided_most", kWalk.unguided_most, "the same of unguided paths, by throughput", "Mitsuba 0.6"),
    entry("walk.untrained_least", kWalk.untrained_least, "least probability to survive before the first tree",
          kProgram2017),
    entry("walk.guided_survival", kWalk.guided_survival,
          "probability to survive by guiding.roulette = \"constant\", and at most before the first tree", kProgram2017),
    entry("walk.candidate_fair", kWalk.candidate_fair,
          "least share of a candidate direction in what is taken, times their number",
          "bench/log/2026-11-25-candidates.md"),
    entry("walk.split_often", kWalk.split_often,
          "glass before the camera: the other way is followed with so many times its weight",
          "bench/log/2026-11-24-split-glass.md"),
    entry("walk.split_least", kWalk.split_least, "and at least this probability", kGuess),
    entry("learning.spatial_threshold", kLearning.spatial_threshold,
          "c of the spatial split rule for 512 x 512 pixels, in proportion to their fourth root", kTree),
    entry("learning.product_cells", kLearning.product_cells,
          "cells of views that learn products, over those of all regions", kViews),
    entry("learning.free_cells", kLearning.free_cells, "as many cells of views are never too many", kViews),
    entry("learning.least_use", kLearning.least_use,
          "of a region's cells, what is left where the BSDF is sampled instead", kTree),
    entry("learning.lights_unlearned", kLearning.lights_unlearned,
          "what stays of the choice of emitters without what is learned: one that was never seen may be seen yet",
          kLights),
    entry("learning.lights_prior_vertices", kLearning.lights_prior_vertices,
          "the parent's choice of emitters counts as much as so many vertices", kLights),
    entry("learning.least_bsdf_fraction", kLearning.least_bsdf_fraction,
          "never 0: where the tree has seen nothing the BSDF alone reaches everything", kTree),
    entry("learning.mixture_prior_records", kLearning.mixture_prior_records,
          "the parent's BSDF fraction counts as much as so many average records", kTree),
    entry("learning.idle_fraction", kLearning.idle_fraction,
          "a region's views are released where all of them deserve less than this share of the samples", kViews),
    entry("learning.idle_passes", kLearning.idle_passes, "so many passes in a row", kViews),
    entry("learning.least_view_gain", kLearning.least_view_gain, "or gain less than this, nats per record", kViews),
    entry("learning.least_view_gain_of_all", kLearning.least_view_gain_of_all,
          "all views are released where together they gain less than this, nats per record of the whole tree", kViews),
    entry("learning.initial_depth", kLearning.initial_depth,
          "depth of a region's quadtree before anything is known: where the rule \"more than 1 % of the energy\" ends "
          "for even light",
          "Mueller et al. 2017, section 3.2"),
    entry(
        "learning.kept_evidence", kLearning.kept_evidence,
        "what regions know of emitters, next event, mixtures and a qtable's visits counts so much with each pass after",
        kGuess),
    entry("grids.halvings", kGrids.halvings, "a grid has 2^this regions (guiding.grid_halvings = 0)", kGuess),
    entry("grids.table_halvings", kGrids.table_halvings,
          "a qtable too: its cells learn means, which need fewer records", kGuess),
    entry("grids.even_part", kGrids.even_part,
          "part of a grid's samples that all strata of directions share alike: light that no record has found must be "
          "found",
          kGuess),
    entry("grids.table_floor", kGrids.table_floor, "least weight of a qtable's stratum, of its region's mean", kGuess),
    entry("lights.least_cut", kLamps.least_cut,
          "area lights whose longest side is shorter than this share of the scene's radius are not cut", kGuess),
    entry("lights.few_triangles", kLamps.few_triangles, "nor are patches of a mesh with so many triangles at most",
          kGuess),
    entry("lights.small_share", kLamps.small_share, "nor those of at most this share of the mesh's area", kGuess),
    entry(
        "lights.least_area", kLamps.least_area,
        "of the squared diagonal of all lamps: what boxes count in the light tree's cost at least, so that lamps in a "
        "line have some as well",
        kGuess),
    entry("lights.far_lanes", kLamps.far_lanes, "of the tree's root that emitters at infinity may have", kGuess),
    entry("splats.nearest", kSplats.nearest,
          "light of a lamp at the lens is seen from this squared distance at least, over that of the scene", kGuess),
    entry("splats.alike", kSplats.alike,
          "but that counts only where it is more than so many times that from the scene's distance", kGuess),
    entry("schedule.kickstart_spp", kSchedule.kickstart_spp,
          "kick-start samples emitters directly in passes that begin with fewer samples per pixel", kProgram2017),
    entry("schedule.teaching_share", kSchedule.teaching_share,
          "an open budget's pass teaches while at least so many times its samples are still to be rendered", kBudgets),
    entry("schedule.guessed_spp", kSchedule.guessed_spp, "samples per pixel by which an open budget is planned",
          kGuess),
    entry("schedule.samples_per_unit", kSchedule.samples_per_unit,
          "samples of a work unit, at most: around half a second of a core; no influence on the image", kGuess),
    entry("schedule.least_weighed_spp", kSchedule.least_weighed_spp,
          "shorter passes know too little of their own variance to be weighed by it", kProgram2019),
    entry("schedule.kickstart_weight", kSchedule.kickstart_weight,
          "weight of each record of a kick-start pass, in which light samples are records, too", kProgram2019),
    entry("farm.half_life", kFarm.half_life, "of a worker's measured speed, seconds", kGuess),
    entry("farm.most_seconds", kFarm.most_seconds, "of work that a worker is handed at once", kGuess),
    entry("farm.part", kFarm.part, "of a worker's part of what is left, that it is handed at once", kGuess),
    entry("farm.copy_gain", kFarm.copy_gain, "a unit is given to a second worker that saves so many seconds ...",
          kGuess),
    entry("farm.copy_ratio", kFarm.copy_ratio, "... and so many times what it takes there", kGuess),
    entry("budget.time_tolerance", kBudget.time_tolerance, "how far a render may be from budget.seconds, share of it",
          kBudgets),
    entry("budget.least_tolerance", kBudget.least_tolerance, "but not less than so many seconds ...", kBudgets),
    entry("budget.most_tolerance", kBudget.most_tolerance, "... as long as that is no more than this share", kBudgets),
    entry("budget.hedge", kBudget.hedge,
          "share of the time left that an ending pass takes, so that a wrong forecast can be made up for", kBudgets),
    entry("budget.probe", kBudget.probe,
          "share of the time left that a strict render tries its last tree for, thrown away", kBudgets),
    entry("budget.spp_to_believe", kBudget.spp_to_believe, "samples from which on an estimated error may end a render",
          kBudgets),
    entry("budget.spp_to_believe_zero", kBudget.spp_to_believe_zero, "the same of an error of zero", kBudgets),
    entry("budget.least_share", kBudget.least_share,
          "a pass that makes up for a missed target renders at least this share of what there is", kBudgets),
    entry("budget.error_margin", kBudget.error_margin,
          "passes that end for an error have so many times the samples needed", kBudgets),
    entry("budget.strict_error_margin", kBudget.strict_error_margin, "the same of a strict render", kBudgets),
    entry("budget.least_left", kBudget.least_left,
          "no pass begins where less time is left than this share of the tolerance", kGuess),
    entry("budget.worth_hedging", kBudget.worth_hedging,
          "an ending pass takes all the time left where hedge would leave less than this share of the tolerance",
          kGuess),
    entry("budget.most_late", kBudget.most_late,
          "the shortest pass may end late by less than this share of the tolerance, and than the time left", kGuess),
    entry("forecast.learned", kForecast.learned,
          "after two trees that brought the variance below this share, a forecast is a bound", kError),
    entry("forecast.noisy", kForecast.noisy,
          "half the width of the error's own interval, relative, above which it is too noisy to forecast by", kError),
    entry("forecast.far", kForecast.far, "more than so many times the samples done is too far ahead", kError),
    entry("forecast.fading", kForecast.fading,
          "progress from one tree to the next is the progress before to this power", kError),
    entry("forecast.cost_fading", kForecast.cost_fading, "the same of what a sample costs", kError),
    entry("forecast.least_progress", kForecast.least_progress,
          "no tree is trusted to bring the variance below this share", kError),
    entry("forecast.most_cost_ratio", kForecast.most_cost_ratio, "nor to change a sample's cost by more", kError),
    entry("forecast.trees_at_rest", kForecast.trees_at_rest,
          "so many trees that are no better than each other have learned all", kError),
    entry("forecast.recording_share", kForecast.recording_share,
          "what keeping records takes of tracing; 6 to 23 % on eight scenes", kError),
    entry("tails.outlier", kTails.outlier,
          "a sample is remembered by name where it alone is so much of its pixel's variance", kGuess),
    entry("tails.noise_part", kTails.noise_part, "of an image's noise, by the fewest pixels that carry it", kGuess),
    entry("tails.told_share", kTails.told_share, "it is said at the end where they are a smaller share of all pixels",
          kGuess),
    entry("tails.least_pixels", kTails.least_pixels, "but not of smaller images", kGuess),
};

/// Measured sensitivity: work over that with the constant unchanged, mean over six scenes.
struct Sensitivity {
    std::string_view name;
    const char* at_half_and_twice;
    const char* when;  ///< date of the page in bench/log, and what has changed since
};

constexpr const char *kFirst = "2026-11-26", *kSecond = "2026-11-28";  // bench/log/{this}-policy.md

constexpr Sensitivity kSensitivities[] = {
    {"guiding.giving_up", "0.96, 0.98", kSecond},
    {"guiding.giving_up_errors", "1.00, 0.96", kSecond},
    {"guiding.taking_up", "1.00, 1.00", kSecond},
    {"guiding.mistrusted", "1.00, 1.00", kSecond},
    {"guiding.ray_cost", "0.98, 1.19", kSecond},
    {"next_event.lent_vertices", "1.00, 1.00", kSecond},
    {"next_event.standard_errors", "0.99, 1.02", kSecond},
    {"next_event.least_gain", "1.00, 1.00", kSecond},
    {"next_event.learned", "1.02, 0.99", kSecond},
    {"next_event.sample_cost", "1.01, 0.99", kSecond},
    {"splitting.usual", "1.00, 0.99", kFirst},
    {"splitting.least_share", "1.00, 0.98", kFirst},
    {"walk.adjoint_window", "0.99, 1.02", kFirst},
    {"walk.unguided_most", "0.98, 1.13", "2026-11-26, before unguided_window"},
    {"walk.candidate_fair", "1.00, 1.00", kFirst},
    {"learning.spatial_threshold", "0.97, 1.03", kFirst},
    {"learning.product_cells", "1.00, 1.00", kFirst},
    {"learning.lights_unlearned", "0.97, 1.05", "2026-11-26, as lights_by_power, before the light tree"},
    {"learning.mixture_prior_records", "0.99, 0.99", kFirst},
    {"schedule.kickstart_spp", "1.00, 1.00", kFirst},
};

static_assert(std::all_of(std::begin(kSensitivities), std::end(kSensitivities), [](const Sensitivity& sensitivity) {
    return std::any_of(std::begin(kEntries), std::end(kEntries),
                       [&](const PolicyEntry& entry) { return sensitivity.name == entry.name; });
}));

std::string sensitivity_of(std::string_view name) {
    for (const Sensitivity& sensitivity : kSensitivities)
        if (sensitivity.name == name) return std::string(sensitivity.at_half_and_twice) + " (" + sensitivity.when + ")";
    return "";
}

}  // namespace

std::string value_text(const PolicyEntry& entry) {
    return entry.single ? number_text(static_cast<float>(entry.value)) : number_text(entry.value);
}

std::span<const PolicyEntry> policy_table() {
    return kEntries;
}

std::string write_policy() {
    std::string text, section;
    for (const PolicyEntry& entry : kEntries) {
        const std::string name = entry.name, head = name.substr(0, name.find('.'));
        if (head != section) text += (text.empty() ? "[policy." : "\n[policy.") + head + "]\n";
        section = head;
        text += name.substr(head.size() + 1) + " = " + value_text(entry) + "\n";
    }
    return text;
}

void check_policy(std::span<const Setting> settings, const Location& file) {
    std::vector<std::string> known;
    known.reserve(kEntries.size());
    for (const PolicyEntry& entry : kEntries)
        known.push_back(std::string(kPolicyPrefix) + entry.name);
    for (const Setting& setting : settings) {
        if (!setting.key.starts_with(kPolicyPrefix) ||
            std::find(known.begin(), known.end(), setting.key) != known.end())
            continue;
        const std::string nearest = nearest_word(setting.key, known);
        throw InputError(setting.where, setting.key + " is no constant of this build",
                         (nearest.empty() ? "" : "did you mean " + nearest + "? Otherwise ") + kResolvedCure);
    }
    for (const PolicyEntry& entry : kEntries) {
        const std::string key = std::string(kPolicyPrefix) + entry.name;
        const auto written =
            std::find_if(settings.begin(), settings.end(), [&](const Setting& s) { return s.key == key; });
        if (written == settings.end())
            throw InputError(file,
                             key + " is not in it: the build that wrote it had no such constant, or it was taken out",
                             kResolvedCure);
        if (written->value != value_text(entry))
            throw InputError(written->where,
                             key + " was " + written->value + ", and is " + value_text(entry) + " in this build",
                             kResolvedCure);
    }
}

std::string policy_documentation() {
    std::string text = "| constant | value | meaning | work at half, at twice | evidence |\n|---|---|---|---|---|\n";
    for (const PolicyEntry& entry : kEntries)
        text += std::string("| `") + entry.name + "` | " + value_text(entry) + " | " + entry.meaning + " | " +
                sensitivity_of(entry.name) + " | " + entry.evidence + " |\n";
    return text;
}

}  // namespace treefarm
