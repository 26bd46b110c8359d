// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "common/base/error.h"
#include "worker/lights/discrete_table.h"

namespace treefarm {

/// Choice of a light path's emitter in one pass: by power, or by the emitters' contributions to the image in earlier
/// passes (common/decide/emission/emission_shares.h). `power` must outlive it.
class EmissionChoice {
  public:
    /// `emphasis`: factor per entry, or empty. Throws RunError if its size is not that of `power`.
    explicit EmissionChoice(const DiscreteTable& power, std::span<const float> emphasis = {}) : power_(power) {
        if (emphasis.empty()) return;
        if (emphasis.size() != power.size()) throw RunError("a pass for a different number of emitters");
        std::vector<double> weights;
        double sum = 0;
        for (std::uint32_t i = 0; i < power.size(); ++i) {
            if (!(emphasis[i] >= 0.0f && emphasis[i] < 1e30f))
                throw RunError("an emphasis of an emitter that is negative or too large");
            weights.push_back(double(power.probability(i)) * double(emphasis[i]));
            sum += weights.back();
        }
        if (!(sum > 0)) return;
        // Learned values may be wrong: no emitter is chosen much less often than by power.
        constexpr auto kUnlearned = double(0.2f);  // not 0.2: images keep their bits
        for (std::uint32_t i = 0; i < power.size(); ++i)
            weights[i] = (1 - kUnlearned) * weights[i] / sum + kUnlearned * double(power.probability(i));
        learned_ = DiscreteTable(weights);
    }

    /// Whether contributions of earlier passes affect the choice.
    bool learned() const { return !learned_.empty(); }
    std::uint32_t size() const { return power_.size(); }
    std::uint32_t pick(std::uint32_t bits) const { return table().pick(bits); }
    float probability(std::uint32_t entry) const { return table().probability(entry); }
    /// Probability over that of the choice by power.
    double factor(std::uint32_t entry) const {
        return learned_.empty() ? 1.0 : double(learned_.probability(entry)) / double(power_.probability(entry));
    }

  private:
    const DiscreteTable& table() const { return learned_.empty() ? power_ : learned_; }

    const DiscreteTable& power_;
    DiscreteTable learned_;
};

/// Probabilities by EmissionChoice of the parts of environments, addressed by next event's entries.
struct EmissionProbabilities {
    const EmissionChoice* choice = nullptr;  ///< nullptr: by power
    std::uint32_t offset = 0;                ///< next event's entry minus EmissionChoice's, modulo 2^32

    bool by_power() const { return choice == nullptr; }
    float operator()(std::uint32_t entry) const { return choice->probability(entry - offset); }
};

}  // namespace treefarm
