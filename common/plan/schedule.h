#pragma once

#include <cstdint>
#include <vector>

#include "common/config/job.h"

namespace treefarm {

/// One pass: what it renders and how it teaches.
struct PassPlan {
    std::uint32_t index = 0;
    std::uint32_t spp = 0;              ///< samples per pixel
    std::uint32_t first_sample = 0;     ///< spp done before it
    bool next_event = false;            ///< sample emitters directly
    bool record = false;                ///< teach the tree (the last pass does not)
    double record_weight = 1.0;         ///< 0.5 in kick-start passes
    bool learn_mixture = false;         ///< teach how often to sample the BSDF (needs a tree that guides)
    std::uint32_t blocks_per_unit = 1;  ///< power of two: sample blocks (of 64) in a work unit
    std::uint32_t chunks = 1;           ///< work units along the samples of a pixel
};

/// Passes double from guiding.spp_unit; when what remains after a pass would be less than twice that pass, the pass
/// takes the rest. The budget is rounded up to whole units. Pure.
std::vector<PassPlan> plan_passes(const Job& job);

/// c sqrt(n_k / 4): records above which a region splits before pass k. n_k is what doubling gives, spp_unit 2^k, also
/// where the last pass is longer: as in the authors' program.
double spatial_split_threshold(const Job& job, const PassPlan& coming_pass);

}  // namespace treefarm
