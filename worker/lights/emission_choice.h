// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "common/base/error.h"
#include "worker/lights/discrete_table.h"

namespace treefarm {

/// The choice of the emitter that a light path starts from, in one pass: by power, or as passes before found what each
/// brings to the image (common/film/emission_shares.h). `power` must outlive it.
class EmissionChoice {
  public:
    /// `emphasis`: of each entry, or empty. Throws RunError where it is of other emitters.
    explicit EmissionChoice(const DiscreteTable& power, std::span<const float> emphasis = {}) : power_(power) {
        if (emphasis.empty()) return;
        if (emphasis.size() != power.size()) throw RunError("a pass over other emitters");
        std::vector<double> weights;
        double sum = 0;
        for (std::uint32_t i = 0; i < power.size(); ++i) {
            if (!(emphasis[i] >= 0.0f && emphasis[i] < 1e30f)) throw RunError("an emitter that is chosen in no way");
            weights.push_back(double(power.probability(i)) * double(emphasis[i]));
            sum += weights.back();
        }
        if (!(sum > 0)) return;
        // What was learned may be wrong: none is chosen much less often than by power.
        constexpr auto kUnlearned = double(0.2f);
        for (std::uint32_t i = 0; i < power.size(); ++i)
            weights[i] = (1 - kUnlearned) * weights[i] / sum + kUnlearned * double(power.probability(i));
        learned_ = DiscreteTable(weights);
    }

    /// Whether it is another than by power.
    bool learned() const { return !learned_.empty(); }
    std::uint32_t size() const { return power_.size(); }
    std::uint32_t pick(std::uint32_t bits) const { return table().pick(bits); }
    float probability(std::uint32_t entry) const { return table().probability(entry); }
    /// The probability over that by power.
    double factor(std::uint32_t entry) const {
        return learned_.empty() ? 1.0 : double(learned_.probability(entry)) / double(power_.probability(entry));
    }

  private:
    const DiscreteTable& table() const { return learned_.empty() ? power_ : learned_; }

    const DiscreteTable& power_;
    DiscreteTable learned_;
};

/// Probabilities by EmissionChoice of parts of what shines from infinity, which next event numbers otherwise.
struct EmissionProbabilities {
    const EmissionChoice* choice = nullptr;  ///< nullptr: by power
    std::uint32_t offset = 0;                ///< of next event's entries against its own, modulo 2^32

    bool by_power() const { return choice == nullptr; }
    float operator()(std::uint32_t entry) const { return choice->probability(entry - offset); }
};

}  // namespace treefarm
