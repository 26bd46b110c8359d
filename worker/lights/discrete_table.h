// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace treefarm {

/// Discrete distribution by weights. Probabilities are whole multiples of 2^-32, so that pick() with 32 random bits and
/// probability() agree exactly. An entry below that granularity is never picked.
class DiscreteTable {
  public:
    DiscreteTable() = default;

    /// Weights are non-negative and finite; if all are zero nothing may be picked.
    explicit DiscreteTable(std::span<const double> weights) {
        double total = 0;
        for (const double w : weights)
            total += w;
        if (!(total > 0)) return;
        begin_.reserve(weights.size() + 1);
        begin_.push_back(0);
        double sum = 0;
        for (const double w : weights) {
            sum += w;
            begin_.push_back(static_cast<std::uint64_t>(std::min(sum / total, 1.0) * 0x1p32));
        }
        // The last entry with weight takes the rounding remainder.
        for (std::size_t i = weights.size(); i > 0; --i) {
            begin_[i] = std::uint64_t(1) << 32;
            if (weights[i - 1] > 0) break;
        }
    }

    bool empty() const { return begin_.empty(); }

    std::uint32_t size() const { return begin_.empty() ? 0 : static_cast<std::uint32_t>(begin_.size() - 1); }
    /// Begin of an entry's interval in [0, 2^32); for the index one past the last: 2^32.
    std::uint64_t begin(std::uint32_t index) const { return begin_[index]; }

    /// Entry whose interval contains `bits`; the table must not be empty.
    std::uint32_t pick(std::uint32_t bits) const {
        // An equal number of steps for any bits, without a branch.
        const std::uint64_t* at = begin_.data();
        for (std::size_t count = begin_.size() - 1; count > 1; count -= count / 2)
            at += at[count / 2] <= bits ? count / 2 : 0;
        return static_cast<std::uint32_t>(at - begin_.data());
    }

    float probability(std::uint32_t index) const {
        return begin_.empty() ? 0.0f : static_cast<float>(begin_[index + 1] - begin_[index]) * 0x1p-32f;
    }

  private:
    std::vector<std::uint64_t> begin_;  ///< in [0, 2^32]; one more than entries
};

}  // namespace treefarm
