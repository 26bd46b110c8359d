// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "common/film/trace_stats.h"
#include "common/plan/schedule/schedule.h"
#include "worker/lights/emission_choice.h"

namespace treefarm {

/// What light paths of a unit bring to the image, by the emitters that they start from: later passes choose these by it
/// (common/film/emission_shares.h).
class EmissionRecord {
  public:
    /// `learns`: whether anybody asks.
    EmissionRecord(const EmissionChoice& choice, bool learns, const PassPlan& pass, EmissionSums& sums)
        : choice_(choice),
          learns_(learns && choice.size() > 1),
          per_square_(std::ldexp(1.0, -2 * pass.layers.splats.exponent - kSquareBits)),
          sums_(sums) {
        if (!learns_) return;
        sums_.paths.assign(choice.size(), 0);
        sums_.squares.assign(choice.size(), 0);
    }

    /// A path that starts there.
    void start(std::uint32_t entry) {
        if (learns_) ++sums_.paths[entry];
    }

    /// The square of the luminance that such a path brings to a pixel. Whole quanta: any order gives the same sums.
    void add(std::uint32_t entry, double square) {
        if (!learns_ || !(square > 0)) return;
        const double factor = choice_.factor(entry);
        const double quanta = std::min(square * factor * factor * per_square_, kMost);
        std::uint64_t& sum = sums_.squares[entry];
        sum = std::min(sum + static_cast<std::uint64_t>(std::llround(quanta)), kMostSplatSum);
    }

  private:
    static constexpr double kMost = 0x1p44;  ///< of one contribution

    const EmissionChoice& choice_;
    const bool learns_;
    const double per_square_;
    EmissionSums& sums_;
};

}  // namespace treefarm
