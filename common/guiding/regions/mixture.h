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

/// How often to sample the BSDF rather than the tree, learned per region from histograms that merge exactly, once per
/// pass, instead of by an optimiser's step per record (docs/design/guiding.md, "mixture").
///
/// A direction is drawn from p_s = a p_B + (1 - a) p_T. With r = p_B / (p_B + p_T), bin b of the histogram collects
/// H_b = sum of f |cos| L / p_s over the directions whose r falls into it. Its expectation is the integral of f |cos| L
/// there, whatever a was, so histograms of passes, regions and workers add up.

/// Bin of a direction with these densities (per steradian).
inline std::uint8_t mixture_bin(float bsdf_pdf, float tree_pdf) {
    if (!(bsdf_pdf > 0.0f)) return 0;  // also where neither has a density: only a view reaches it
    const float position = bsdf_pdf / (bsdf_pdf + tree_pdf) * static_cast<float>(kMixtureBins);
    if (!(position > 0.0f)) return 0;  // also NaN
    return static_cast<std::uint8_t>(position < static_cast<float>(kMixtureBins) ? position : kMixtureBins - 1);
}

/// r at the centre of a bin, (0, 1).
inline double mixture_bin_centre(int bin) {
    return (bin + 0.5) / kMixtureBins;
}

using MixtureHistogram = std::array<double, kMixtureBins>;

/// Fraction a in [learning.least_bsdf_fraction (policy.h), 1] that brings the mixture closest to f |cos| L in
/// Kullback-Leibler divergence: it maximises sum_b H_b log(a r_b + (1 - a)(1 - r_b)) + prior_weight (prior log a + (1 -
/// prior) log(1 - a)), which is concave. `prior_weight` is in the units of the histogram.
double best_bsdf_fraction(const MixtureHistogram& histogram, double prior, double prior_weight);

/// The coordinator's memory of the mixtures from pass to pass.
class MixtureLearner {
  public:
    /// Sets next.bsdf_fraction from what the pass over `tree` recorded. `origins` says which region of `tree` each of
    /// `next` came from. Older passes count half as much with each pass; a split region's parts share its histogram.
    void learn(const RegionModel& tree, const CellSums& sums, std::span<const RegionOrigin> origins, RegionModel& next);

    /// Lists what it remembers, for a checkpoint.
    template <class Archive>
    void serialize(Archive& archive) {
        archive(histograms_);
    }

  private:
    std::vector<MixtureHistogram> histograms_;  ///< per region of the coming tree, in radiance, not in quanta
};

}  // namespace treefarm
