// SPDX-License-Identifier: Apache-2.0
#include "common/film/guiding_worth.h"

#include <algorithm>
#include <cmath>

#include "common/math/saturating.h"

namespace treefarm {
namespace {

/// Adds a value in whole units; what is no number counts nothing.
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

double GuidingWorth::low() const {
    return worth * std::exp(-error);
}
double GuidingWorth::high() const {
    return worth * std::exp(error);
}

GuidingWorth guiding_worth(const UnguidedSums& sums, std::span<const PixelEstimate> pixels, const ImageLevels& levels,
                           std::size_t width, double guided_cost) {
    constexpr std::size_t kGroups = UnguidedSums::kGroups;
    if (levels.inverse_levels.empty() || sums.cost == 0 || pixels.empty()) return {};
    const auto samples = static_cast<double>(pixels.front().whole().n);
    if (samples < 2) return {};
    std::array<double, kGroups> means{};  // squares of the pixels' means
    for (std::size_t p = 0; p < pixels.size(); ++p) {
        const double mean = luminance(pixels[p].whole().mean) * static_cast<double>(levels.at(p, width));
        means[pixel_group(static_cast<std::uint32_t>(p % width), static_cast<std::uint32_t>(p / width))] += mean * mean;
    }
    // Of all pixels of a group together: variances of guided and of unguided samples.
    std::array<double, kGroups> guided, unguided;
    double all_guided = 0, all_unguided = 0;
    for (std::size_t g = 0; g < kGroups; ++g) {
        const double moment = static_cast<double>(sums.guided[g]) * UnguidedSums::kMomentUnit / samples;
        guided[g] = std::max(moment - means[g], 0.0) * samples / (samples - 1);
        unguided[g] =
            static_cast<double>(sums.unguided[g]) * UnguidedSums::kMomentUnit / samples - (moment - guided[g]);
        all_guided += guided[g];
        all_unguided += unguided[g];
    }
    const auto count = static_cast<double>(pixels.size());
    GuidingWorth worth;
    worth.guided_cost = guided_cost;
    worth.unguided_cost = static_cast<double>(sums.cost) * UnguidedSums::kCostUnit / (count * samples);
    constexpr double kLeast = 1e-9;  // no noise at all
    worth.guided_variance = all_guided / count;
    worth.unguided_variance = std::max(all_unguided / count, kLeast * std::max(worth.guided_variance, kLeast));
    if (!(worth.guided_variance > 0 && guided_cost > 0 && worth.unguided_cost > 0)) return {};
    worth.worth = worth.unguided_variance * worth.unguided_cost / (worth.guided_variance * worth.guided_cost);
    // The spread of the logarithm, by leaving groups out.
    double sum = 0, squares = 0, weight = 0, weights = 0;
    for (std::size_t g = 0; g < kGroups; ++g) {
        const double others_guided = all_guided - guided[g], others_unguided = all_unguided - unguided[g];
        const double log = others_guided > 0 && others_unguided > 0
                               ? std::log(others_unguided / others_guided)
                               : std::log(worth.unguided_variance / worth.guided_variance);
        sum += log;
        squares += log * log;
        const double part = std::max(unguided[g], 0.0);
        weight += part;
        weights += part * part;
    }
    constexpr auto kN = static_cast<double>(kGroups);
    worth.error = std::sqrt(std::max(squares - sum * sum / kN, 0.0) * (kN - 1) / kN);
    worth.known = weights > 0 ? weight * weight / weights : 0;
    return worth;
}

}  // namespace treefarm
