// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/guiding/regions/refinement.h"
#include "common/guiding/regions/region_model.h"
#include "common/guiding/statistics/cell_sums.h"

namespace treefarm {

/// Probability of sampling the BSDF instead of the guide, learned per region once per pass from histograms that merge
/// exactly, not by an optimiser's step per record (docs/design/guiding.md, "mixture").
///
/// A vertex may have any number of techniques. They are learned one by one, each beside the mixture of those before it,
/// as the guide's first (density p_T) beside the BSDF (p_B) here, with that mixture's density in place of p_B
/// (worker/guides/technique_list.h). A direction is drawn from p_s = a p_B + (1 - a) p_T. With r = p_B / (p_B + p_T),
/// bin b of the histogram collects H_b = sum of f |cos| L / p_s over the directions whose r is in the bin. Its
/// expectation is the integral of f |cos| L over these directions, independent of a, so histograms of passes, regions
/// and workers add up.

/// Histogram bin of a direction with these densities (per steradian).
inline std::uint8_t mixture_bin(float bsdf_pdf, float tree_pdf) {
    if (!(bsdf_pdf > 0.0f)) return 0;  // also if both densities are 0: only a view reaches it
    const float position = bsdf_pdf / (bsdf_pdf + tree_pdf) * static_cast<float>(kMixtureBins);
    if (!(position > 0.0f)) return 0;  // also NaN
    return static_cast<std::uint8_t>(position < static_cast<float>(kMixtureBins) ? position : kMixtureBins - 1);
}

/// Value of r at the centre of a bin, in (0, 1).
inline double mixture_bin_centre(int bin) {
    return (bin + 0.5) / kMixtureBins;
}

using MixtureHistogram = std::array<double, kMixtureBins>;

/// Sum over the bins, in their unit.
double histogram_total(const MixtureHistogram& histogram);

/// Fraction a in [learning.least_bsdf_fraction (policy.h), 1] that brings the mixture closest to f |cos| L in
/// Kullback-Leibler divergence. It maximises sum_b H_b log(a r_b + (1 - a)(1 - r_b)) + prior_weight (prior log a + (1 -
/// prior) log(1 - a)), which is concave. `prior_weight` is in the units of the histogram.
double best_bsdf_fraction(const MixtureHistogram& histogram, double prior, double prior_weight);

/// Learned fraction of the techniques before one technique, in the mixture of both: of the BSDF beside the region's
/// distribution, or of what a region samples without a further technique beside that one. `bins`: sums of a pass, in
/// units of 2^exponent, from `records` vertices; they are added to `histogram`, whose earlier sums lose weight by
/// kKeptEvidence. `prior`, the fraction before, counts as learning.mixture_prior_records (policy.h) records; it is kept
/// without evidence.
double learn_fraction(MixtureHistogram& histogram, std::span<const std::uint64_t> bins, int exponent,
                      std::uint64_t records, double prior);

/// Learner of the mixtures.
class MixtureLearner {
  public:
    /// Sets next.bsdf_fraction from the records of the pass over `tree`. `origins`: for each region of `next` the
    /// region of `tree` that it came from. The weight of older passes halves with each pass; parts of a split region
    /// share its histogram.
    void learn(const RegionModel& tree, const CellSums& sums, std::span<const RegionOrigin> origins, RegionModel& next);

    /// Archives the state, for a checkpoint.
    template <class Archive>
    void serialize(Archive& archive) {
        archive(histograms_);
    }

  private:
    std::vector<MixtureHistogram> histograms_;  ///< per region of the next tree, in radiance, not in quanta
};

}  // namespace treefarm
