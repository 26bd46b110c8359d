// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "common/decide/light_subpaths/light_subpath_gain.h"
#include "common/decide/splitting/splitting_gain.h"
#include "common/film/develop.h"
#include "common/film/work_unit.h"
#include "common/plan/resolve/resolve.h"
#include "common/plan/schedule/kernel_choice.h"

namespace treefarm {

/// Work units of a pass, by kind.
struct PassUnits {
    bool tiles = true;
    std::uint32_t light_paths = 0;       ///< per pixel, in ranges; path i has pixel i mod pixels as its key
    std::uint32_t first_light_path = 0;  ///< per pixel, in earlier passes
    std::uint32_t chains = 0;            ///< Markov chains, in ranges

    bool operator==(const PassUnits&) const = default;
};

/// Layers of a pass's image.
struct PassLayers {
    bool estimates = true;  ///< tiles give an estimate of each of their pixels
    SplatShape splats{};    ///< units may add to any pixel

    bool operator==(const PassLayers&) const = default;
};

/// Plan of one pass: what it renders and what it teaches.
struct PassPlan {
    std::uint32_t index = 0;
    std::uint32_t spp = 0;              ///< samples per pixel
    std::uint32_t first_sample = 0;     ///< samples per pixel of earlier passes
    bool next_event = false;            ///< samples emitters directly
    bool guided = true;                 ///< guided by the model, if there is one
    bool split = true;                  ///< may split paths, if the job allows it
    bool light_subpaths = true;         ///< of an estimator from both ends; without, it traces camera paths only
    bool record = false;                ///< records for the guide (the last pass does not)
    double record_weight = 1.0;         ///< 0.5 in kick-start passes
    bool learn_mixture = false;         ///< learns the probability of sampling the BSDF (needs a model that guides)
    bool last_tree = false;             ///< its tree is the last refinement: only a resumed render learns more
    std::uint32_t blocks_per_unit = 1;  ///< power of two: sample blocks (of 64) in a work unit
    std::uint32_t chunks = 1;           ///< work units along the samples of a pixel

    /// Samples of a pixel in a work unit, except in the last chunk.
    std::uint32_t unit_spp() const { return std::min(spp, blocks_per_unit * kBlockSamples); }

    /// Paths of a whole unit: a tile, or a range in passes without tiles.
    std::uint64_t unit_paths(int tile_size) const {
        if (!units.tiles) return kRangePaths;
        const auto edge = static_cast<std::uint64_t>(tile_size);
        return edge * edge * unit_spp();
    }

    /// Whether units are so long that with two of them queued no thread waits for an answer, so that messages need not
    /// be polled often.
    bool has_long_units(int tile_size) const {
        constexpr std::uint64_t kLongPaths = 16384;
        return unit_paths(tile_size) >= kLongPaths;
    }

    KernelChoice kernel{};  ///< instance of the path kernel
    PassUnits units{};
    PassLayers layers{};
    std::vector<float> emission{};  ///< emission_emphasis() of earlier passes; empty: light paths start by power

    /// Paths per pixel that splat: light paths if there are any, else the samples of tiles.
    HalfCounts splatting_paths() const {
        return units.light_paths > 0 ? half_counts(units.first_light_path, units.light_paths)
                                     : half_counts(first_sample, spp);
    }

    /// Markov chains that splat; even and odd ones are the two halves.
    HalfCounts splatting_chains() const { return half_counts(0, units.chains); }

    bool operator==(const PassPlan&) const = default;
};

/// Work units of a pass, in order of issue: tiles row by row, then ranges.
std::vector<WorkUnit> cut_pass(const PassPlan& pass, int width, int height, int tile_size);

/// The pass of a job at this position of the schedule. `last`: no later pass could learn from it.
PassPlan make_pass(const Resolved& job, std::uint32_t index, std::uint32_t first_sample, std::uint32_t spp, bool last);

/// Sets next_event or record, and the members that depend on it.
void set_next_event(PassPlan& pass, const Resolved& job, bool next_event);
void set_record(PassPlan& pass, const Resolved& job, bool record);

/// Verdict on guiding from finished passes; never final.
enum class Guiding {
    open,   ///< it pays, or this is unknown: the next pass is guided
    loses,  ///< the next pass is unguided
};

/// Applies the rule "while_it_pays" of guiding.rule: if guiding loses, a pass is unguided and teaches nothing.
void set_guiding(PassPlan& pass, const Resolved& job, Guiding guiding);

/// Applies the rule "while_it_pays" of guiding.splitting_rule: once splitting was found not to pay, no path is split.
void set_splitting(PassPlan& pass, const Resolved& job, bool pays);

/// Whether splitting may pay, after a pass with this gain. A negative answer is final, since without splitting there
/// are no new measurements.
bool splitting_may_pay(const PassPlan& pass, const SplittingGain& gain);

/// Applies the rule "while_it_pays" of bidirectional.light_subpaths: once light subpaths were found not to pay, passes
/// trace camera paths only, which do not splat.
void set_light_subpaths(PassPlan& pass, const Resolved& job, bool pays);

/// Whether light subpaths may pay, after a pass with this gain. A negative answer is final.
bool light_subpaths_may_pay(const PassPlan& pass, const LightSubpathGain& gain);

/// Passes of a job. They double from guiding.spp_unit; if the rest after a pass would be less than twice that pass, the
/// pass takes the rest. The budget is rounded up to whole units. For an open budget (budget.seconds, budget.error),
/// whose passes are chosen one by one (budget.h), a guess for planning: those of budget.spp, at least 64. Pure.
std::vector<PassPlan> plan_passes(const Resolved& job);

/// Length of pass number `index` if `remaining` is left, both in guiding.spp_unit.
std::uint32_t next_units(std::uint32_t index, std::uint32_t remaining);

/// Whether clock or estimated error choose the passes.
bool has_open_budget(const Resolved& job);

/// Factor sqrt(n_k / 4) by which split thresholds grow up to pass k. n_k is the length by doubling, spp_unit 2^k, even
/// if the last pass is longer, as in the authors' program.
double split_growth(const Resolved& job, const PassPlan& coming_pass);

/// Threshold c sqrt(n_k / 4): records above which a region splits before pass k.
double spatial_split_threshold(const Resolved& job, const PassPlan& coming_pass);

}  // namespace treefarm
