// SPDX-License-Identifier: Apache-2.0
#include "common/film/splitting_gain.h"

#include <algorithm>
#include <cmath>

namespace treefarm {
namespace {

/// Unit of the sums: 64 bits hold almost 2^29 pixels of the largest variance.
constexpr double kSplitUnit = 4096;

std::uint64_t in_split_units(double value) {
    return static_cast<std::uint64_t>(std::llround(std::max(value, 0.0) * kSplitUnit));
}

}  // namespace

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

SplittingGain splitting_gain(const TraceStats& stats) {
    const SplittingSums& sums = stats.splitting;
    if (sums.split_variance == 0 || sums.split_mean == 0) return {};
    const auto ratio = [](std::uint64_t a, std::uint64_t b) { return static_cast<double>(a) / static_cast<double>(b); };
    return {ratio(sums.unsplit_variance, sums.split_variance), ratio(stats.rays, stats.rays - stats.split_path_rays),
            ratio(sums.unsplit_mean, sums.split_mean)};
}

}  // namespace treefarm
