// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/decide/pass/pass_plan.h"
#include "common/evidence/block_shape.h"
#include "common/film/trace_counts.h"

namespace treefarm {

/// Measurement, by the render itself, of whether splitting of paths pays: a split path also gives the value that it
/// would have had alone, so each camera path is two samples of its pixel, split and unsplit. Both come from the same
/// paths and differ only by the splitting, so a few samples suffice.

/// Sums over pixels of a pass that may split paths, with and without the split paths; whole units.
struct SplittingSums {
    std::uint64_t split_mean = 0, unsplit_mean = 0;
    std::uint64_t split_variance = 0, unsplit_variance = 0;  ///< of one sample

    static constexpr BlockShape kBlock{"splitting", "1/4096 of light", BlockKind::sums, 1, 4};
    template <class Sums, class Visit>
    static constexpr void each(Sums& sums, Visit visit) {
        visit(sums.split_mean);
        visit(sums.unsplit_mean);
        visit(sums.split_variance);
        visit(sums.unsplit_variance);
    }
    void add(const SplittingSums& other);
};

/// Samples of a pixel, each of them split and unsplit.
class PairedSamples {
  public:
    /// Adds a sample. Luminances are in any common scale that does not depend on them; NaN and infinity are skipped,
    /// and larger values than kMost are reduced to it.
    void add(double split, double unsplit);
    /// Adds the pixel's results to `sums`, in whole units, and resets them.
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

/// Gain by splitting, from the guided samples of a pass that may split.
struct SplittingGain {
    double variance = 0;  ///< variance of unsplit samples over that of split ones; 0: unknown
    double rays = 0;      ///< rays of split samples over those of unsplit ones
    /// Mean of the unsplit samples over that of the split ones: 1, except for chance. If it is low, unsplit samples
    /// have missed rare light, and their noise is unknown.
    double mean_ratio = 0;

    template <class Archive>
    void serialize(Archive& archive) {
        archive(variance, rays, mean_ratio);
    }
};
SplittingGain splitting_gain(const SplittingSums& sums, const TraceCounts& counts);

/// Whether splitting may pay, after a pass with this gain. A negative answer is final, since without splitting there
/// are no new measurements.
bool splitting_may_pay(const PassPlan& pass, const SplittingGain& gain);

}  // namespace treefarm
