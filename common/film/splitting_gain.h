// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/film/trace_stats.h"

namespace treefarm {

/// Whether splitting paths pays, measured by the render itself: a path that was split also knows what it would have
/// carried alone, so each camera path is two samples of its pixel, with split paths and without. Told apart by the same
/// paths, the two differ in nothing but the splitting, and a few samples tell.

/// Samples of a pixel, each of them split and unsplit.
class PairedSamples {
  public:
    /// Luminances, at any common scale that does not depend on them; those that are none are left out, larger ones than
    /// kMost taken for it.
    void add(double split, double unsplit);
    /// Adds what the samples tell to `sums`, in whole units, and forgets them.
    void finish(SplittingSums& sums);

    static constexpr double kMost = 4096;

  private:
    struct Sums {
        double first = 0, second = 0;
        void add(double value);
    };
    int count_ = 0;
    Sums split_, unsplit_;
};

/// Gain by splitting, of the guided samples of a pass that may split.
struct SplittingGain {
    double variance = 0;  ///< of unsplit samples over that of split ones; 0: not known
    double rays = 0;      ///< of split samples over those of unsplit ones
    /// Mean of the unsplit samples over that of the split ones, which is 1 but for chance. Where it is low unsplit
    /// samples have missed rare light, and nobody knows how noisy they are.
    double mean_ratio = 0;
};
SplittingGain splitting_gain(const TraceStats& stats);

}  // namespace treefarm
