// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "common/decide/pass/kernel_choice.h"
#include "common/film/develop.h"
#include "common/film/work_unit.h"

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

}  // namespace treefarm
