#include "common/plan/schedule.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "common/film/work_unit.h"

namespace treefarm {
namespace {

/// Kick-start samples emitters directly in passes that begin with fewer samples per pixel than this (PPG's program).
constexpr std::uint32_t kKickstartSpp = 128;
/// Guiding whose bulk gains less than this share of the light that unguided samples find does not pay: light that they
/// miss would be noise. Below 1: guiding gets better with each tree (docs/design/guiding.md, "auto"), and equal noise
/// is 0.71.
constexpr double kLosingBulk = 0.75;
/// Without next event unguided samples find light by chance, and bright paths that they have not met yet make no noise.
/// The spaceship's bulk gains 0.64 to 0.81 there after 8 to 32 spp, and guiding ends with 1.4 times less error.
constexpr double kLosingBulkAlone = 0.5;
/// Unless the few pixels that are left out there say clearly that it does.
constexpr double kWinningFew = 1.5;
/// Short passes have to say more loudly that it does not, shorter ones have no say.
constexpr std::uint32_t kLeastJudgedSpp = 4, kLeastTrustedSpp = 8;
constexpr double kLosingFew = 0.55;
/// Of the light, by unguided samples: with less nobody knows how noisy they are.
constexpr double kLeastCoverage = 0.8;
/// Splitting has to quieten samples at all. Shorter passes have no say, nor have those whose unsplit samples find less
/// light.
constexpr double kLeastQuietened = 1.01, kLeastFound = 0.99;
constexpr std::uint32_t kLeastSplitSpp = 16;
/// It may cost a little more than it shows: whole renders gain more by it, without next event most
/// (bench/log/2026-11-25-splitting.md).
constexpr double kLeastSplittingGain = 0.97, kLeastSplittingGainAlone = 0.9;
/// With next event renders that never split are quieter than unsplit samples show, which are a copy's and play roulette
/// with its share of the throughput. And a copy's ray takes longer than others do.
constexpr double kShownGain = 2.2, kCopyRayCost = 1.4;
/// Passes that probe: the first ones that have a tree and enough samples to know their variance.
constexpr std::uint32_t kLeastProbeSpp = 4, kProbePasses = 4;
/// Samples per pixel by which an open budget is planned.
constexpr std::uint32_t kGuessedSpp = 64;
/// A work unit is at most about this many samples of a full tile: around half a second on one core.
constexpr std::uint32_t kSamplesPerUnit = 1u << 18;

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

void set_next_event(PassPlan& pass, const Job& job, bool next_event) {
    pass.next_event = next_event;
    pass.record_weight = next_event && job.integrator.next_event == NextEvent::kickstart ? 0.5 : 1.0;
}

void set_record(PassPlan& pass, const Job& job, bool record) {
    pass.record = record;
    pass.learn_mixture = record && pass.index > 0 && job.guiding.learn_bsdf_fraction;
}

void set_guiding(PassPlan& pass, const Job& job, Guiding guiding) {
    if (job.guiding.type != GuidingType::automatic) return;
    if (guiding == Guiding::loses) {
        pass.guided = false;
        set_record(pass, job, false);
    }
    pass.probe = guiding == Guiding::open && pass.record && pass.index > 0 && pass.index <= kProbePasses &&
                 pass.spp >= kLeastProbeSpp && pass.guided;
}

Guiding judge_guiding(const PassPlan& pass, const GuidingGain& gain) {
    if (gain.all == 0 || pass.spp < kLeastJudgedSpp) return Guiding::open;
    if (gain.coverage < kLeastCoverage) return Guiding::pays;
    const bool wins_by_few = gain.all >= (pass.spp < kLeastTrustedSpp ? kLosingFew : kWinningFew);
    const double losing = pass.next_event ? kLosingBulk : kLosingBulkAlone;
    return gain.bulk >= losing * std::min(gain.coverage, 1.0) || wins_by_few ? Guiding::open : Guiding::loses;
}

void set_splitting(PassPlan& pass, const Job& job, bool pays) {
    if (job.guiding.splitting == 0) pass.split = pays;
}

bool splitting_may_pay(const PassPlan& pass, const SplittingGain& gain) {
    if (pass.spp < kLeastSplitSpp || gain.variance == 0 || gain.found < kLeastFound) return true;
    if (gain.variance < kLeastQuietened) return false;
    if (!pass.next_event) return gain.variance >= kLeastSplittingGainAlone * gain.rays;
    const double quieter = 1 + (gain.variance - 1) / kShownGain, slower = 1 + (gain.rays - 1) * kCopyRayCost;
    return quieter >= kLeastSplittingGain * slower;
}

PassPlan make_pass(const Job& job, std::uint32_t index, std::uint32_t first_sample, std::uint32_t spp, bool last) {
    PassPlan pass;
    pass.index = index;
    pass.spp = spp;
    pass.first_sample = first_sample;
    const bool kickstart = job.integrator.next_event == NextEvent::kickstart && first_sample < kKickstartSpp;
    set_next_event(pass, job, kickstart || job.integrator.next_event == NextEvent::always);
    set_record(pass, job, job.guiding.type != GuidingType::none && !last);
    cut_into_units(pass, job.farm.tile_size);
    return pass;
}

std::vector<PassPlan> plan_passes(const Job& job) {
    const auto unit = static_cast<std::uint32_t>(job.guiding.spp_unit);
    const std::uint32_t spp = has_open_budget(job) ? std::max(job.budget.spp, kGuessedSpp) : job.budget.spp;
    std::uint32_t remaining = (spp + unit - 1) / unit;  // in units
    std::vector<PassPlan> passes;
    std::uint32_t done = 0;
    for (std::uint32_t index = 0; remaining > 0; ++index) {
        std::uint32_t units = std::min(remaining, std::uint32_t{1} << std::min(index, 31u));
        if (remaining - units < 2 * units) units = remaining;  // the last pass takes at least half of everything
        remaining -= units;
        passes.push_back(make_pass(job, index, done, units * unit, remaining == 0));
        done += units * unit;
    }
    return passes;
}

bool has_open_budget(const Job& job) {
    return job.budget.seconds > 0 || job.budget.error > 0;
}

double split_growth(const Job& job, const PassPlan& coming_pass) {
    const double nominal_spp =
        std::ldexp(static_cast<double>(job.guiding.spp_unit), static_cast<int>(coming_pass.index));
    return std::sqrt(nominal_spp / 4.0);
}

double usual_spatial_threshold(double film_pixels) {
    return 2000.0 * std::sqrt(std::sqrt(film_pixels / (512.0 * 512.0)));
}

double spatial_split_threshold(const Job& job, double film_pixels, const PassPlan& coming_pass) {
    const double c =
        job.guiding.spatial_threshold > 0 ? job.guiding.spatial_threshold : usual_spatial_threshold(film_pixels);
    return c * split_growth(job, coming_pass);
}

}  // namespace treefarm
