// SPDX-License-Identifier: Apache-2.0
#include "common/decide/splitting/splitting_gain.h"

#include <algorithm>
#include <cmath>

#include "common/decide/splitting/splitting_constants.h"
#include "common/math/saturating.h"

namespace treefarm {
namespace {

/// Unit of the sums: 64 bits hold almost 2^29 pixels of the largest variance.
constexpr double kSplitUnit = 4096;

std::uint64_t in_split_units(double value) {
    return static_cast<std::uint64_t>(std::llround(std::max(value, 0.0) * kSplitUnit));
}

}  // namespace

void SplittingSums::add(const SplittingSums& other) {
    add_saturating(split_mean, other.split_mean);
    add_saturating(unsplit_mean, other.unsplit_mean);
    add_saturating(split_variance, other.split_variance);
    add_saturating(unsplit_variance, other.unsplit_variance);
}

void PairedSamples::Sums::add(double value) {
    value = std::min(value, kMost);
    first += value;
    second += value * value;
}

void PairedSamples::add(double split, double unsplit) {
    if (!(split >= 0 && unsplit >= 0 && std::isfinite(split) && std::isfinite(unsplit))) return;
    ++count_;
    split_.add(split);
    unsplit_.add(unsplit);
}

void PairedSamples::finish(SplittingSums& sums) {
    const double n = count_;
    const auto variance = [n](const Sums& s) { return (s.second - s.first * s.first / n) / (n - 1); };
    if (count_ > 1) {
        sums.split_mean += in_split_units(split_.first / n);
        sums.unsplit_mean += in_split_units(unsplit_.first / n);
        sums.split_variance += in_split_units(variance(split_));
        sums.unsplit_variance += in_split_units(variance(unsplit_));
    }
    *this = {};
}

SplittingGain splitting_gain(const SplittingSums& sums, const TraceCounts& counts) {
    if (sums.split_variance == 0 || sums.split_mean == 0) return {};
    const auto ratio = [](std::uint64_t a, std::uint64_t b) { return static_cast<double>(a) / static_cast<double>(b); };
    return {ratio(sums.unsplit_variance, sums.split_variance), ratio(counts.rays, counts.rays - counts.split_path_rays),
            ratio(sums.unsplit_mean, sums.split_mean)};
}

bool splitting_may_pay(const PassPlan& pass, const SplittingGain& gain) {
    if (pass.spp < tuned<policy::kSplitting, std::uint32_t>("splitting.least_spp") || gain.variance == 0 ||
        gain.mean_ratio < tuned<policy::kSplitting>("splitting.least_found"))
        return true;
    if (gain.variance < tuned<policy::kSplitting>("splitting.least_quietened")) return false;
    if (!pass.next_event) return gain.variance >= tuned<policy::kSplitting>("splitting.least_gain_alone") * gain.rays;
    const double quieter = 1 + (gain.variance - 1) / tuned<policy::kSplitting>("splitting.shown_gain"),
                 slower = 1 + (gain.rays - 1) * tuned<policy::kSplitting>("splitting.copy_ray_cost");
    return quieter >= tuned<policy::kSplitting>("splitting.least_gain") * slower;
}

}  // namespace treefarm
