// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/decide/pass/pass_plan.h"
#include "common/evidence/block_shape.h"
#include "common/film/trace_counts.h"

namespace treefarm {

/// Measurement, by the render itself, of whether light subpaths pay: a bidirectional sample also gives the value of its
/// camera path alone, weighted as next event and scattering would do between themselves. Both values come from the same
/// path, so a few samples suffice.

/// Sums over pixels of a pass whose samples are also known without their light subpaths; whole units.
struct LightSubpathSums {
    std::uint64_t samples = 0;  ///< number of samples behind the next four sums
    std::uint64_t both_mean = 0, alone_mean = 0;
    std::uint64_t both_variance = 0, alone_variance = 0;  ///< of one sample
    std::uint64_t alone_rays = 0;  ///< rays of samples without light subpaths, shadow rays included

    static constexpr BlockShape kBlock{"light subpaths", "samples, 2^-24 of light, rays", BlockKind::sums, 1, 6};
    template <class Sums, class Visit>
    static constexpr void each(Sums& sums, Visit visit) {
        visit(sums.samples);
        visit(sums.both_mean);
        visit(sums.alone_mean);
        visit(sums.both_variance);
        visit(sums.alone_variance);
        visit(sums.alone_rays);
    }
    void add(const LightSubpathSums& other);
    bool operator==(const LightSubpathSums&) const = default;

    template <class Archive>
    void serialize(Archive& archive) {
        archive(samples, both_mean, alone_mean, both_variance, alone_variance, alone_rays);
    }
};

/// Samples of a pixel, each with its light subpath and without.
class SubpathPairs {
  public:
    /// Contributions of one sample.
    struct Sample {
        double own = 0;                        ///< luminance at its own pixel
        double alone = 0;                      ///< luminance there without the light subpath
        double splats = 0, splat_squares = 0;  ///< sum and sum of squares of contributions to any pixel
    };

    /// Adds a sample. Luminances are in a common scale that does not depend on them, near 1. NaN and infinity are
    /// skipped; larger values than LightSubpaths::most_of_mean are reduced to it.
    void add(const Sample& sample);
    /// Adds the pixel's results to `sums`, in whole units, and resets them. A single sample gives none.
    void finish(LightSubpathSums& sums);

  private:
    int count_ = 0;
    double own_ = 0, own_squares_ = 0, alone_ = 0, alone_squares_ = 0, splats_ = 0, splat_squares_ = 0;
};

/// Gain by light subpaths, from a pass that compared.
struct LightSubpathGain {
    /// Variance of one sample without light subpaths over that with them; 0: unknown. If the samples without have
    /// missed a caustic, their variance ignores it and may be below that of splats that found it. But two means of the
    /// same light differ only by their errors, so the difference is an error, and its square is added as variance.
    double noise = 0;
    double rays = 0;  ///< rays of samples with light subpaths over those without
    /// Mean of the samples without light subpaths over that with them: 1, except for chance and for light that only
    /// light subpaths find. If it is low, the noise of samples without is unknown.
    double mean_ratio = 0;

    /// Ratio of noise at equal cost, without light subpaths over with them: above 1 they pay. 0: unknown.
    double at_equal_cost() const;

    template <class Archive>
    void serialize(Archive& archive) {
        archive(noise, rays, mean_ratio);
    }
};
LightSubpathGain light_subpath_gain(const LightSubpathSums& sums, const TraceCounts& counts);

/// Whether light subpaths may pay, after a pass with this gain. A negative answer is final.
bool light_subpaths_may_pay(const PassPlan& pass, const LightSubpathGain& gain);

}  // namespace treefarm
