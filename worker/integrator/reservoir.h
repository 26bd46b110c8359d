#pragma once

#include "worker/integrator/guided_sampling.h"

namespace treefarm {

/// Resampled importance sampling (Talbot et al. 2005): of several directions y_i, each drawn with the density q(y_i),
/// one is kept with a probability in proportion to w_i = p^(y_i) / q(y_i). The target p^ is the product of f |cos| and
/// the light that the region has learned, which neither the BSDF nor the tree samples alone. W = sum_i w_i / (M p^(y))
/// then stands for 1 / density: E[f |cos| L W] is the integral of f |cos| L wherever p^ > 0, however bad the target.
/// The density of y has no closed form; against next event it is weighed by q, on both sides.
class Reservoir {
  public:
    void clear() { sum_ = 0.0f; }

    /// Offers the next direction; `u` is uniform in [0, 1).
    void offer(const ScatterSample& s, float u) {
        if (!(s.pdf > 0.0f)) return;
        const float target = this->target(s);
        const float weight = target / s.pdf;
        if (!(weight > 0.0f)) return;
        sum_ += weight;
        if (!(u * sum_ < weight)) return;
        kept_ = s;
        kept_target_ = target;
    }

    /// The direction kept of `count` that were drawn, those that failed included. False if none was.
    bool take(std::uint32_t count, ScatterSample& s) const {
        if (!(sum_ > 0.0f)) return false;
        s = kept_;
        s.effective_pdf = static_cast<float>(count) * kept_target_ / sum_;
        return true;
    }

  private:
    /// The learned light is mixed with 5 % of the same from everywhere: it may miss what there is.
    static float target(const ScatterSample& s) {
        constexpr float kEverywhere = 0.2f / (4.0f * kPi);
        return average(s.f_cos) * (s.guide_pdf + kEverywhere);
    }

    ScatterSample kept_;
    float sum_ = 0.0f, kept_target_ = 0.0f;
};

}  // namespace treefarm
