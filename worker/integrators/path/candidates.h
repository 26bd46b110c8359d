// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "common/base/policy.h"
#include "worker/integrators/path/scatter_sample.h"

namespace treefarm {

/// Largest number of candidate directions of a vertex.
inline constexpr std::uint32_t kMostCandidates = 4;

/// Choice of one of several directions (after resampled importance sampling, Talbot et al. 2005). Of M directions y_i,
/// each drawn with density q, direction j is chosen with a probability P_j that may depend on all of them. 1 / (M
/// q(y_j) P_j) then replaces 1 / density: the expectation of f |cos| L / (M q P) equals that of the mean of f |cos| L /
/// q over the candidates, for any P that is positive wherever the surface reflects.
///
/// P is mostly proportional to f |cos| times the radiance that the region has learned, a product that neither the BSDF
/// nor the tree samples alone; a part of P is uniform, so that the weight of a direction is at most 1 / candidate_fair
/// (policy.h) times its weight without candidates. The density of the chosen direction has no closed form; MIS against
/// next event uses q, on both sides.
template <class Scatter>
class Candidates {
  public:
    void clear() { count_ = 0; }

    /// Storage for the next direction, of at most kMostCandidates; offer() makes it a candidate.
    Scatter& next() { return samples_[count_]; }

    void offer() {
        const Scatter& s = samples_[count_];
        if (!(s.pdf > 0.0f)) return;
        const float weight = average(s.f_cos) * (s.guide_pdf + kUnseen) / s.pdf;
        if (!(weight > 0.0f)) return;
        // Any choice is unbiased; the clamp avoids division by a sum of 0 or infinity.
        weights_[count_++] = std::clamp(weight, 1e-30f, 1e30f);
    }

    /// Chooses one of `drawn` directions, failed ones included; `u` is uniform in [0, 1). False if all failed.
    bool take(std::uint32_t drawn, float u, Scatter& s) const {
        if (count_ == 0) return false;
        float sum = 0.0f;
        for (std::uint32_t i = 0; i < count_; ++i)
            sum += weights_[i];
        const float fair = tuned<float>("walk.candidate_fair") / static_cast<float>(count_);
        const float preferred = (1.0f - tuned<float>("walk.candidate_fair")) / sum;
        std::uint32_t taken = 0;
        float probability = fair + preferred * weights_[0];
        for (float before = probability; taken + 1 < count_ && !(u < before); before += probability)
            probability = fair + preferred * weights_[++taken];
        s = samples_[taken];
        s.effective_pdf = static_cast<float>(drawn) * s.pdf * probability;
        return true;
    }

  private:
    /// Radiance assumed from everywhere, since the tree may not have seen a light: that of an even tree. A fifth of it
    /// was too little for rare light (bench/log/guiding.md, "how much regard to light that the tree has not seen").
    static constexpr float kUnseen = 1.0f / (4.0f * kPi);

    std::uint32_t count_ = 0;
    std::array<float, kMostCandidates> weights_;
    std::array<Scatter, kMostCandidates> samples_;
};

}  // namespace treefarm
