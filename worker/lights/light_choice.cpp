// SPDX-License-Identifier: Apache-2.0
#include "worker/lights/light_choice.h"

#include <algorithm>
#include <numeric>

namespace treefarm {

LightChoice::LightChoice(LightSelection how, std::span<const double> power, std::span<const LightBounds> bounds)
    : by_power_(how == LightSelection::power) {
    std::vector<double> weights(power.begin(), power.end());
    const auto shining =
        static_cast<std::size_t>(std::count_if(weights.begin(), weights.end(), [](double p) { return p > 0; }));
    const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
    if (shining > 1 && by_point(how)) {
        by_point_ = true;
        for (double& w : weights)
            w = w > 0 ? 0.5 * w / total + 0.5 / static_cast<double>(shining) : 0.0;
        if (shining <= FlatLights::kMost)
            flat_.emplace(bounds, weights);
        else
            tree_.emplace(bounds, weights);
    } else if (how == LightSelection::even) {
        for (double& w : weights)
            w = w > 0 ? 1.0 : 0.0;
    }
    table_ = DiscreteTable(weights);
}

LightPick LightChoice::pick_by_point(const Draw& random, const LightReceiver& receiver) const {
    if (flat_) return flat_->pick(random[0], receiver);
    // The levels of the tree use other bits than the choice of a point, which follows.
    const std::uint64_t others = std::uint64_t{random[2]} << 32 | random[3];
    return tree_->pick((std::uint64_t{random[0]} << 32 | random[1]) ^ next_bits(others) >> 32, receiver);
}

float LightChoice::probability_by_point(std::uint32_t entry, const LightReceiver& receiver) const {
    return flat_ ? flat_->probability(entry, receiver) : tree_->probability(entry, receiver).probability;
}

}  // namespace treefarm
