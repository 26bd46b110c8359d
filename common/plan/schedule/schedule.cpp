// SPDX-License-Identifier: Apache-2.0
#include "common/plan/schedule/schedule.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "common/base/policy.h"
#include "common/config/estimators.h"
#include "common/film/work_unit.h"

namespace treefarm {
namespace {

constexpr std::uint32_t kSamplesPerUnit = 1u
                                          << 18;  ///< at most: around half a second of a core; any gives the same bits
constexpr std::uint32_t kGuessedSpp = 64;         ///< by which an open budget is planned

void cut_into_units(PassPlan& pass, int tile_size) {
    const std::uint32_t blocks = (pass.spp + kBlockSamples - 1) / kBlockSamples;
    const auto tile_samples =
        static_cast<std::uint32_t>(tile_size) * static_cast<std::uint32_t>(tile_size) * kBlockSamples;
    // Any cut gives the same bits; only aligned runs of 2^j blocks are whole subtrees of the reduction.
    pass.blocks_per_unit =
        std::clamp(std::bit_floor(std::max(kSamplesPerUnit / tile_samples, 1u)), 1u, std::bit_ceil(blocks));
    pass.chunks = (blocks + pass.blocks_per_unit - 1) / pass.blocks_per_unit;
}

}  // namespace

std::vector<WorkUnit> cut_pass(const PassPlan& pass, int width, int height, int tile_size) {
    std::vector<WorkUnit> units;
    if (pass.units.tiles) units = cut_tiles(pass.index, pass.chunks, width, height, tile_size);
    const std::uint64_t pixels = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
    for (const auto& ranges :
         {cut_range(pass.index, UnitKind::light_paths, pixels * pass.units.light_paths, kRangePaths),
          cut_range(pass.index, UnitKind::chains, pass.units.chains, 1)})
        units.insert(units.end(), ranges.begin(), ranges.end());
    return units;
}

void set_next_event(PassPlan& pass, const Resolved& job, bool next_event) {
    pass.next_event = next_event;
    const bool kickstart = next_event && job.integrator.next_event == NextEvent::kickstart;
    pass.record_weight = kickstart ? tuned("schedule.kickstart_weight") : 1.0;
}

void set_record(PassPlan& pass, const Resolved& job, bool record) {
    pass.record = record;
    pass.last_tree = !record;
    const bool has_model = pass.index > 0 || !job.guiding.initial_model.empty();
    pass.learn_mixture = record && has_model && job.guiding.learn_bsdf_fraction;
}

PassPlan make_pass(const Resolved& job, std::uint32_t index, std::uint32_t first_sample, std::uint32_t spp, bool last) {
    PassPlan pass;
    pass.index = index;
    pass.spp = spp;
    pass.first_sample = first_sample;
    pass.guided = job.guides;
    const bool kickstart = job.integrator.next_event == NextEvent::kickstart &&
                           first_sample < tuned<std::uint32_t>("schedule.kickstart_spp");
    set_next_event(pass, job, kickstart || job.integrator.next_event == NextEvent::always || job.decides_next_event);
    const bool is_long = spp >= static_cast<std::uint32_t>(job.guiding.initial_model_spp);
    set_record(pass, job, job.guides && !last && is_long);
    cut_into_units(pass, job.farm.tile_size);
    const Estimator& estimator = estimator_of(job.integrator.type);
    if (!estimator.has_camera_paths()) {
        pass.units = {.tiles = false, .light_paths = spp, .first_light_path = first_sample};
        pass.layers.estimates = false;
    }
    if (estimator.splats())
        pass.layers.splats = {static_cast<std::uint32_t>(job.scene_facts.film_pixels), job.scene_facts.splat_exponent};
    return pass;
}

std::uint32_t next_units(std::uint32_t index, std::uint32_t remaining) {
    const std::uint32_t doubled = std::min(remaining, std::uint32_t{1} << std::min(index, 31u));
    return remaining - doubled < 2 * doubled ? remaining : doubled;  // the last pass takes at least half of everything
}

std::vector<PassPlan> plan_passes(const Resolved& job) {
    const auto unit = static_cast<std::uint32_t>(job.guiding.spp_unit);
    const std::uint32_t spp = has_open_budget(job) ? std::max(job.budget.spp, kGuessedSpp) : job.budget.spp;
    std::uint32_t remaining = (spp + unit - 1) / unit;  // in units
    std::vector<PassPlan> passes;
    std::uint32_t done = 0;
    for (std::uint32_t index = 0; remaining > 0; ++index) {
        const std::uint32_t units = next_units(index, remaining);
        remaining -= units;
        passes.push_back(make_pass(job, index, done, units * unit, remaining == 0));
        done += units * unit;
    }
    return passes;
}

bool has_open_budget(const Resolved& job) {
    return job.budget.seconds > 0 || job.budget.error > 0;
}

double split_growth(const Resolved& job, const PassPlan& coming_pass) {
    const double nominal_spp =
        std::ldexp(static_cast<double>(job.guiding.spp_unit), static_cast<int>(coming_pass.index));
    return std::sqrt(nominal_spp / 4.0);
}

double spatial_split_threshold(const Resolved& job, const PassPlan& coming_pass) {
    return job.guiding.spatial_threshold * split_growth(job, coming_pass);
}

}  // namespace treefarm
