#pragma once

#include <array>
#include <span>
#include <vector>

#include "common/guiding/refine.h"
#include "common/guiding/tree_update.h"

namespace treefarm {

/// How often to sample the BSDF, T1 and T2 where a view guides: learned as in mixture.h, with three densities. Draw
/// from p_s = a_B p_B + a_1 p_1 + a_2 p_2. With r_j = p_j / (p_B + p_1 + p_2) the bins cut the simplex of (r_B, r_1,
/// r_2): eight steps of r_B by four of r_2 / (r_1 + r_2).
inline constexpr int kBsdfSteps = 8, kViewSteps = kViewMixtureBins / kBsdfSteps;

/// Bin of a direction with these densities (per steradian, not all zero).
inline std::uint8_t view_mixture_bin(float bsdf_pdf, float tree_pdf, float view_pdf) {
    const auto step = [](float part, float whole, int steps) {
        if (!(part > 0.0f)) return 0;  // also where the whole is 0
        const float place = part / whole * static_cast<float>(steps);
        if (!(place > 0.0f)) return 0;  // also NaN
        return place < static_cast<float>(steps) ? static_cast<int>(place) : steps - 1;
    };
    const float trees = tree_pdf + view_pdf;
    return static_cast<std::uint8_t>(step(bsdf_pdf, bsdf_pdf + trees, kBsdfSteps) * kViewSteps +
                                     step(view_pdf, trees, kViewSteps));
}

using ViewMixtureHistogram = std::array<double, kViewMixtureBins>;

/// Probabilities of sampling the BSDF, T1 and T2; they sum to one.
struct ViewFractions {
    double bsdf = 0.5, tree = 0.5, view = 0;
};

/// The fractions that maximise sum_b H_b log(sum_j a_j r_jb) + prior_weight sum_j prior_j log a_j, with a_B at least
/// kLeastBsdfFraction. `prior_weight` is in the units of the histogram.
ViewFractions best_view_fractions(const ViewMixtureHistogram& histogram, const ViewFractions& prior,
                                  double prior_weight);

/// How much better `fractions` fit the histogram than the best without T2: nats per record, about twice the relative
/// excess of variance where it is small.
double view_gain(const ViewMixtureHistogram& histogram, const ViewFractions& fractions);

/// What the coordinator remembers of views from pass to pass.
class ViewLearner {
  public:
    /// Adds what the pass over `tree` recorded; what it thinks of its views then, for refine().
    std::vector<ViewAdvice> judge(const SdTree& tree, const TreeSums& sums);
    /// Sets the fractions of the refined tree's views. `origins` as in RefineReport.
    void hand_down(std::span<const ViewOrigin> origins, SdTree& next);

  private:
    struct Evidence {
        ViewMixtureHistogram histogram{};  ///< in what it records, not in quanta
        int idle_passes = 0;               ///< in which T2 was hardly worth sampling
        ViewFractions fractions;
    };
    std::vector<Evidence> views_;  ///< of the coming tree
};

}  // namespace treefarm
