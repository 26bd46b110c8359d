// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "common/decide/emission/emission_shares.h"
#include "common/plan/schedule/schedule.h"
#include "worker/lights/emission_choice.h"

namespace treefarm {

/// Contributions of a unit's light paths to the image, summed by emitter: later passes choose emitters by these sums
/// (common/decide/emission/emission_shares.h).
class EmissionRecord {
  public:
    /// `learns`: whether a later pass uses the sums.
    EmissionRecord(const EmissionChoice& choice, bool learns, const PassPlan& pass, EmissionSums& sums)
        : choice_(choice),
          learns_(learns && choice.size() > 1),
          per_square_(std::ldexp(1.0, -2 * pass.layers.splats.exponent - kSquareBits)),
          sums_(sums) {
        if (!learns_) return;
        sums_.paths.assign(choice.size(), 0);
        sums_.squares.assign(choice.size(), 0);
    }

    /// Counts a path that starts at the emitter `entry`.
    void start(std::uint32_t entry) {
        if (learns_) ++sums_.paths[entry];
    }

    /// Adds the squared luminance of a contribution to a pixel. Sums are whole quanta: equal for any order.
    void add(std::uint32_t entry, double square) {
        if (!learns_ || !(square > 0)) return;
        const double factor = choice_.factor(entry);
        const double quanta = std::min(square * factor * factor * per_square_, kMost);
        std::uint64_t& sum = sums_.squares[entry];
        sum = std::min(sum + static_cast<std::uint64_t>(std::llround(quanta)), kMostSplatSum);
    }

  private:
    static constexpr double kMost = 0x1p44;  ///< largest contribution

    const EmissionChoice& choice_;
    const bool learns_;
    const double per_square_;
    EmissionSums& sums_;
};

}  // namespace treefarm
