// SPDX-License-Identifier: Apache-2.0
#include "common/film/light_subpath_gain.h"

#include <algorithm>
#include <cmath>

#include "common/plan/policy.h"

namespace treefarm {
namespace {

/// 64 bits hold 2^15 blocks of samples of the largest variance there is, and 2^33 of the usual one.
constexpr double kUnitsPerOne = 0x1p30;

std::uint64_t in_units(double value) {
    return static_cast<std::uint64_t>(std::llround(std::max(value, 0.0) * kUnitsPerOne));
}

}  // namespace

void SubpathPairs::add(const Sample& sample) {
    const double most2 = kMost * kMost;
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
    splat_squares_ += std::min(sample.splat_squares, most2);
}

void SubpathPairs::finish(LightSubpathSums& sums) {
    const double n = count_;
    const auto variance = [n](double sum, double squares) { return (squares - sum * sum / n) / (n - 1); };
    if (count_ > 1) {
        sums.both_mean += in_units((own_ + splats_) / n);
        sums.alone_mean += in_units(alone_ / n);
        // Splats are so rare in a pixel that the sum of their squares is the variance of their sum.
        sums.both_variance += in_units(variance(own_, own_squares_) + splat_squares_ / n);
        sums.alone_variance += in_units(variance(alone_, alone_squares_));
    }
    *this = {};
}

double LightSubpathGain::at_equal_cost() const {
    const double cost = rays * kPolicy.light_subpaths.ray_cost;
    return cost > 0 ? noise / cost : 0.0;
}

LightSubpathGain light_subpath_gain(const TraceStats& stats) {
    const LightSubpathSums& sums = stats.light_subpaths;
    if (sums.both_variance == 0 || sums.both_mean == 0 || sums.alone_rays == 0) return {};
    const auto ratio = [](std::uint64_t a, std::uint64_t b) { return static_cast<double>(a) / static_cast<double>(b); };
    return {ratio(sums.alone_variance, sums.both_variance), ratio(stats.rays + stats.shadow_rays, sums.alone_rays),
            ratio(sums.alone_mean, sums.both_mean)};
}

double missed_light_noise(const LightSubpathSums& sums, double samples, double blocks) {
    if (sums.both_variance == 0 || !(samples > 0 && blocks > 0)) return 0.0;
    const auto mean = [blocks](std::uint64_t sum) { return static_cast<double>(sum) / (blocks * kUnitsPerOne); };
    const double variance = mean(sums.both_variance);
    const double error = std::sqrt((variance + mean(sums.alone_variance)) / samples);
    const double missed = mean(sums.both_mean) - mean(sums.alone_mean) - 2 * error;
    return missed > 0 ? missed * missed * samples / variance : 0.0;
}

}  // namespace treefarm
