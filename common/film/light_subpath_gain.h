// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/film/trace_stats.h"

namespace treefarm {

/// Whether light subpaths pay, measured by the render itself: a bidirectional sample also knows what its path from the
/// camera would carry alone, with the weights that next event and scattering have between themselves. So each sample is
/// two, told apart by the same path, and a few tell.

/// Samples of a pixel, each of them with its light subpath and without.
class SubpathPairs {
  public:
    /// What one sample brings.
    struct Sample {
        double own = 0;                        ///< luminance at its own pixel
        double alone = 0;                      ///< what that would be without the light subpath
        double splats = 0, splat_squares = 0;  ///< sum and sum of squares of what it brings to any pixel
    };

    /// Luminances at a common scale that does not depend on them: about 1. Samples that are no numbers are left out,
    /// what is larger than LightSubpaths::most_of_mean is taken for it.
    void add(const Sample& sample);
    /// Adds what the samples tell to `sums`, in whole units, and forgets them. A single one tells nothing.
    void finish(LightSubpathSums& sums);

  private:
    int count_ = 0;
    double own_ = 0, own_squares_ = 0, alone_ = 0, alone_squares_ = 0, splats_ = 0, splat_squares_ = 0;
};

/// Gain by light subpaths, of a pass that compared.
struct LightSubpathGain {
    /// Variance without them over that with them, of one sample; 0: not known. Where samples without them have not met
    /// a caustic yet, their own variance knows nothing of it, and may lie below that of what splats found. But two
    /// means of the same light differ by their errors alone, so what is missed is an error, and its square is variance
    /// over samples.
    double noise = 0;
    double rays = 0;  ///< of samples with them over those without
    /// Mean of the samples without them over that with them, which is 1 but for chance and for light that only they
    /// find. Where it is low nobody knows how noisy samples without them are.
    double mean_ratio = 0;

    /// Noise at equal cost without them, over that with them: above 1 they pay. 0: not known.
    double at_equal_cost() const;
};
LightSubpathGain light_subpath_gain(const TraceStats& stats);

}  // namespace treefarm
