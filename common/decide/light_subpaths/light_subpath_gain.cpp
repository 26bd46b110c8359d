// SPDX-License-Identifier: Apache-2.0
#include "common/decide/light_subpaths/light_subpath_gain.h"

#include <algorithm>
#include <cmath>

#include "common/decide/light_subpaths/light_subpath_constants.h"
#include "common/math/saturating.h"

namespace treefarm {
namespace {

/// Unit of the sums: 64 bits hold those of 2^29 samples of the largest variance, and of 2^40 samples of the usual one.
constexpr double kGainUnit = 0x1p24;

std::uint64_t in_gain_units(double value) {
    return static_cast<std::uint64_t>(std::llround(std::max(value, 0.0) * kGainUnit));
}

/// Part of LightSubpathGain::noise from light that samples without light subpaths miss; 0: none.
double missed_light_noise(const LightSubpathSums& sums) {
    const auto samples = static_cast<double>(sums.samples);
    const auto mean = [samples](std::uint64_t sum) { return static_cast<double>(sum) / (samples * kGainUnit); };
    const double variance = mean(sums.both_variance);
    const double error = std::sqrt((variance + mean(sums.alone_variance)) / samples);
    const double missed = mean(sums.both_mean) - mean(sums.alone_mean);
    return missed > tuned<policy::kLightSubpaths>("light_subpaths.missed_errors") * error
               ? missed * missed * samples / variance
               : 0.0;
}

}  // namespace

void LightSubpathSums::add(const LightSubpathSums& other) {
    add_saturating(samples, other.samples);
    add_saturating(both_mean, other.both_mean);
    add_saturating(alone_mean, other.alone_mean);
    add_saturating(both_variance, other.both_variance);
    add_saturating(alone_variance, other.alone_variance);
    add_saturating(alone_rays, other.alone_rays);
}

void SubpathPairs::add(const Sample& sample) {
    constexpr double kMost = tuned<policy::kLightSubpaths>("light_subpaths.most_of_mean");
    if (!(sample.own >= 0 && sample.alone >= 0 && sample.splat_squares >= 0) ||
        !std::isfinite(sample.own + sample.alone + sample.splats + sample.splat_squares))
        return;
    ++count_;
    const double own = std::min(sample.own, kMost), alone = std::min(sample.alone, kMost);
    own_ += own;
    own_squares_ += own * own;
    alone_ += alone;
    alone_squares_ += alone * alone;
    splats_ += std::min(sample.splats, kMost);
    splat_squares_ += std::min(sample.splat_squares, kMost * kMost);
}

void SubpathPairs::finish(LightSubpathSums& sums) {
    const double n = count_;
    const auto variance = [n](double sum, double squares) { return (squares - sum * sum / n) / (n - 1); };
    if (count_ > 1) {
        sums.samples += static_cast<std::uint64_t>(count_);
        sums.both_mean += in_gain_units(own_ + splats_);
        sums.alone_mean += in_gain_units(alone_);
        // Splats are so rare in a pixel that the sum of their squares is the variance of their sum.
        sums.both_variance += in_gain_units(n * variance(own_, own_squares_) + splat_squares_);
        sums.alone_variance += in_gain_units(n * variance(alone_, alone_squares_));
    }
    *this = {};
}

double LightSubpathGain::at_equal_cost() const {
    const double cost = rays * tuned<policy::kLightSubpaths>("light_subpaths.ray_cost");
    return cost > 0 ? noise / cost : 0.0;
}

LightSubpathGain light_subpath_gain(const LightSubpathSums& sums, const TraceCounts& counts) {
    if (sums.both_variance == 0 || sums.both_mean == 0 || sums.alone_rays == 0) return {};
    const auto ratio = [](std::uint64_t a, std::uint64_t b) { return static_cast<double>(a) / static_cast<double>(b); };
    return {std::max(ratio(sums.alone_variance, sums.both_variance), missed_light_noise(sums)),
            ratio(counts.rays + counts.shadow_rays, sums.alone_rays), ratio(sums.alone_mean, sums.both_mean)};
}

bool light_subpaths_may_pay(const PassPlan& pass, const LightSubpathGain& gain) {
    if (pass.spp < tuned<policy::kLightSubpaths, std::uint32_t>("light_subpaths.least_spp") || gain.noise == 0)
        return true;
    return gain.mean_ratio < tuned<policy::kLightSubpaths>("light_subpaths.least_found") ||
           gain.at_equal_cost() >= tuned<policy::kLightSubpaths>("light_subpaths.least_gain");
}

}  // namespace treefarm
