// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "common/base/policy.h"
#include "worker/integrators/path/scatter_sample.h"

namespace treefarm {

/// Directions of which one may be taken.
inline constexpr std::uint32_t kMostCandidates = 4;

/// One of several directions (after resampled importance sampling, Talbot et al. 2005). Of M directions y_i, each drawn
/// with the density q, number j is taken with a probability P_j that may depend on all of them. 1 / (M q(y_j) P_j) then
/// stands for 1 / density: the expectation of f |cos| L / (M q P) is that of the mean of f |cos| L / q over the
/// candidates, whatever P is, as long as nothing that reflects has P = 0.
///
/// P prefers the product of f |cos| and the light that the region has learned, which neither the BSDF nor the tree
/// samples alone; a part of it prefers nothing, so that a direction is never weighed more than 1 / candidate_fair
/// (policy.h) times as much as alone. The density of what is taken has no closed form; against next event it is weighed
/// by q, on both sides.
template <class Scatter>
class Candidates {
  public:
    void clear() { count_ = 0; }

    /// Room for the next direction, of at most kMostCandidates; offer() makes it one of those that can be taken.
    Scatter& next() { return samples_[count_]; }

    void offer() {
        const Scatter& s = samples_[count_];
        if (!(s.pdf > 0.0f)) return;
        const float weight = average(s.f_cos) * (s.guide_pdf + kUnseen) / s.pdf;
        if (!(weight > 0.0f)) return;
        // Any choice is unbiased; this one divides by no sum of 0 or infinity.
        weights_[count_++] = std::clamp(weight, 1e-30f, 1e30f);
    }

    /// One of `drawn` directions, those that failed included; `u` is uniform in [0, 1). False if all failed.
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
    /// Light from everywhere, of which the tree may have seen nothing: as much as an even tree would see. A fifth of it
    /// was too little for rare light (bench/log/2026-11-25-candidates.md).
    static constexpr float kUnseen = 1.0f / (4.0f * kPi);

    std::uint32_t count_ = 0;
    std::array<float, kMostCandidates> weights_;
    std::array<Scatter, kMostCandidates> samples_;
};

}  // namespace treefarm
