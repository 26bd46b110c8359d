// SPDX-License-Identifier: Apache-2.0
#include "common/decide/guiding/guiding_efficiency.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "common/math/saturating.h"

namespace treefarm {
namespace {

/// Adds a value, rounded to whole units; NaN and infinity are skipped.
void add_units(std::uint64_t& sum, double value, double unit) {
    constexpr double kMost = 0x1p52;
    if (!std::isfinite(value)) return;
    add_saturating(sum, static_cast<std::uint64_t>(std::llround(std::clamp(value / unit, 0.0, kMost))));
}

}  // namespace

void UnguidedSums::add(const UnguidedSums& other) {
    for (std::size_t g = 0; g < kGroups; ++g) {
        add_saturating(guided[g], other.guided[g]);
        add_saturating(unguided[g], other.unguided[g]);
    }
    add_saturating(cost, other.cost);
}

void UnguidedBlock::finish(std::size_t group, UnguidedSums& sums) {
    add_units(sums.guided[group], guided_, UnguidedSums::kMomentUnit);
    add_units(sums.unguided[group], unguided_, UnguidedSums::kMomentUnit);
    add_units(sums.cost, cost_, UnguidedSums::kCostUnit);
    *this = {};
}

double GuidingEfficiency::low() const {
    return efficiency * std::exp(-error);
}
double GuidingEfficiency::high() const {
    return efficiency * std::exp(error);
}

void GuidingEvidence::add(const GuidingEvidence& other) {
    if (other.samples == 0) return;
    samples += other.samples;
    const double part = other.samples / samples;
    const auto mix = [part](double& mean, double added) { mean += part * (added - mean); };
    for (std::size_t g = 0; g < guided.size(); ++g) {
        mix(guided[g], other.guided[g]);
        mix(unguided[g], other.unguided[g]);
    }
    mix(guided_cost, other.guided_cost);
    mix(unguided_cost, other.unguided_cost);
}

GuidingEfficiency GuidingEvidence::efficiency() const {
    const double all_guided = std::accumulate(guided.begin(), guided.end(), 0.0),
                 all_unguided = std::accumulate(unguided.begin(), unguided.end(), 0.0);
    if (!(all_guided > 0 && guided_cost > 0 && unguided_cost > 0)) return {};
    GuidingEfficiency efficiency;
    efficiency.guided_cost = guided_cost;
    efficiency.unguided_cost = unguided_cost;
    constexpr double kLeast = 1e-9;  // stands for no noise
    efficiency.guided_variance = all_guided;
    efficiency.unguided_variance = std::max(all_unguided, kLeast * std::max(all_guided, kLeast));
    efficiency.efficiency = efficiency.unguided_variance * unguided_cost / (all_guided * guided_cost);
    // Standard error of the logarithm, by the jackknife over groups.
    double sum = 0, squares = 0, weight = 0, weights = 0;
    for (std::size_t g = 0; g < guided.size(); ++g) {
        const double others_guided = all_guided - guided[g], others_unguided = all_unguided - unguided[g];
        const double log = others_guided > 0 && others_unguided > 0
                               ? std::log(others_unguided / others_guided)
                               : std::log(efficiency.unguided_variance / efficiency.guided_variance);
        sum += log;
        squares += log * log;
        const double part = std::max(unguided[g], 0.0);
        weight += part;
        weights += part * part;
    }
    constexpr auto kN = static_cast<double>(UnguidedSums::kGroups);
    efficiency.error = std::sqrt(std::max(squares - sum * sum / kN, 0.0) * (kN - 1) / kN);
    efficiency.known = weights > 0 ? weight * weight / weights : 0;
    return efficiency;
}

GuidingEvidence guiding_evidence(const UnguidedSums& sums, std::span<const PixelEstimate> pixels,
                                 const ImageLevels& levels, std::size_t width, double guided_cost) {
    if (levels.inverse_levels.empty() || sums.cost == 0 || pixels.empty()) return {};
    GuidingEvidence evidence;
    const auto samples = static_cast<double>(pixels.front().whole().n), count = static_cast<double>(pixels.size());
    if (samples < 2) return {};
    GuidingEvidence::Groups means{};  // squares of the pixels' means
    for (std::size_t p = 0; p < pixels.size(); ++p) {
        const double mean = luminance(pixels[p].whole().mean) * static_cast<double>(levels.at(p, width));
        means[pixel_group(static_cast<std::uint32_t>(p % width), static_cast<std::uint32_t>(p / width))] += mean * mean;
    }
    for (std::size_t g = 0; g < means.size(); ++g) {
        const double moment = static_cast<double>(sums.guided[g]) * UnguidedSums::kMomentUnit / samples;
        const double guided = std::max(moment - means[g], 0.0) * samples / (samples - 1);
        evidence.guided[g] = guided / count;
        evidence.unguided[g] =
            (static_cast<double>(sums.unguided[g]) * UnguidedSums::kMomentUnit / samples - (moment - guided)) / count;
    }
    evidence.samples = samples;
    evidence.guided_cost = guided_cost;
    evidence.unguided_cost = static_cast<double>(sums.cost) * UnguidedSums::kCostUnit / (count * samples);
    return evidence;
}

}  // namespace treefarm
