// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "common/film/develop.h"
#include "common/film/light_subpath_gain.h"
#include "common/film/splitting_gain.h"
#include "common/film/work_unit.h"
#include "common/plan/resolve/resolve.h"
#include "common/plan/schedule/kernel_choice.h"

namespace treefarm {

/// Units that a pass is cut into.
struct PassUnits {
    bool tiles = true;
    std::uint32_t light_paths = 0;       ///< per pixel, in ranges; path i has pixel i mod pixels as its key
    std::uint32_t first_light_path = 0;  ///< per pixel, done before the pass
    std::uint32_t chains = 0;            ///< in ranges

    bool operator==(const PassUnits&) const = default;
};

/// Layers of a pass's image.
struct PassLayers {
    bool estimates = true;  ///< tiles bring an estimate of each of their pixels
    SplatShape splats{};    ///< units may bring something to any pixel

    bool operator==(const PassLayers&) const = default;
};

/// One pass: what it renders and how it teaches.
struct PassPlan {
    std::uint32_t index = 0;
    std::uint32_t spp = 0;              ///< samples per pixel
    std::uint32_t first_sample = 0;     ///< spp done before it
    bool next_event = false;            ///< sample emitters directly
    bool guided = true;                 ///< by the tree, where there is one
    bool split = true;                  ///< paths may be split, if the job lets them
    bool light_subpaths = true;         ///< an estimator from both ends has them; else it traces paths from the camera
    bool record = false;                ///< teach the tree (the last pass does not)
    double record_weight = 1.0;         ///< 0.5 in kick-start passes
    bool learn_mixture = false;         ///< teach how often to sample the BSDF (needs a tree that guides)
    bool last_tree = false;             ///< its tree was refined as the last one: only a resumed render learns more
    std::uint32_t blocks_per_unit = 1;  ///< power of two: sample blocks (of 64) in a work unit
    std::uint32_t chunks = 1;           ///< work units along the samples of a pixel

    /// Samples of a pixel in a work unit, the last chunk's apart.
    std::uint32_t unit_spp() const { return std::min(spp, blocks_per_unit * kBlockSamples); }

    /// Paths of a whole unit: a tile, or a range where there are no tiles.
    std::uint64_t unit_paths(int tile_size) const {
        if (!units.tiles) return kRangePaths;
        const auto edge = static_cast<std::uint64_t>(tile_size);
        return edge * edge * unit_spp();
    }

    /// Whether units are so long that with two before it no thread waits for an answer, and nobody need look for
    /// messages often.
    bool has_long_units(int tile_size) const {
        constexpr std::uint64_t kLongPaths = 16384;
        return unit_paths(tile_size) >= kLongPaths;
    }

    KernelChoice kernel{};  ///< what traces it
    PassUnits units{};
    PassLayers layers{};
    std::vector<float> emission{};  ///< emission_emphasis() of the passes before; empty: light paths start by power

    /// Paths per pixel that splat: light paths, where there are any, or the samples of tiles.
    HalfCounts splatting_paths() const {
        return units.light_paths > 0 ? half_counts(units.first_light_path, units.light_paths)
                                     : half_counts(first_sample, spp);
    }

    /// Markov chains that splat: even and odd ones are the halves.
    HalfCounts splatting_chains() const { return half_counts(0, units.chains); }

    bool operator==(const PassPlan&) const = default;
};

/// Work units of a pass, in the order in which they are issued: tiles row by row, then ranges.
std::vector<WorkUnit> cut_pass(const PassPlan& pass, int width, int height, int tile_size);

/// A pass as the job makes it at this place of the schedule. `last`: no pass comes after it that could learn from it.
PassPlan make_pass(const Resolved& job, std::uint32_t index, std::uint32_t first_sample, std::uint32_t spp, bool last);

/// Sets next_event or record, with what follows from each.
void set_next_event(PassPlan& pass, const Resolved& job, bool next_event);
void set_record(PassPlan& pass, const Resolved& job, bool record);

/// Whether guiding pays, as far as finished passes tell. Never for good.
enum class Guiding {
    open,   ///< it does, or nobody knows: the next pass is guided
    loses,  ///< the next pass is not
};

/// guiding.rule "while_it_pays": where guiding loses a pass is unguided and teaches nothing.
void set_guiding(PassPlan& pass, const Resolved& job, Guiding guiding);

/// guiding.splitting_rule "while_it_pays": no path is split any more once that was found not to pay.
void set_splitting(PassPlan& pass, const Resolved& job, bool pays);

/// Whether splitting may pay, after a pass with this gain. Once it does not it is not asked again: nobody splits any
/// more.
bool splitting_may_pay(const PassPlan& pass, const SplittingGain& gain);

/// bidirectional.light_subpaths "while_it_pays": once they were found not to pay, passes are made of paths from the
/// camera alone, which splat nothing.
void set_light_subpaths(PassPlan& pass, const Resolved& job, bool pays);

/// Whether light subpaths may pay, after a pass with this gain. Once they do not they are not asked again.
bool light_subpaths_may_pay(const PassPlan& pass, const LightSubpathGain& gain);

/// Passes double from guiding.spp_unit; when what remains after a pass would be less than twice that pass, the pass
/// takes the rest. The budget is rounded up to whole units. For an open budget (budget.seconds, budget.error), whose
/// passes are chosen one by one as the render goes (budget.h), a guess to plan by: those of budget.spp, at least 64.
/// Pure.
std::vector<PassPlan> plan_passes(const Resolved& job);

/// Length of pass number `index` where so much remains, both in guiding.spp_unit.
std::uint32_t next_units(std::uint32_t index, std::uint32_t remaining);

/// Whether clock or estimated error choose the passes.
bool has_open_budget(const Resolved& job);

/// sqrt(n_k / 4), by which thresholds of splits grow to pass k. n_k is what doubling gives, spp_unit 2^k, also where
/// the last pass is longer: as in the authors' program.
double split_growth(const Resolved& job, const PassPlan& coming_pass);

/// c sqrt(n_k / 4): records above which a region splits before pass k.
double spatial_split_threshold(const Resolved& job, const PassPlan& coming_pass);

}  // namespace treefarm
