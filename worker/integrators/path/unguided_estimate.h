// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace treefarm {

/// Estimate of the unguided path that would have had a guided path's directions. Its probability is 1 / ratio times
/// that of the guided path, and its throughput `ratio` times as large. Guided samples thus estimate variance and cost
/// of unguided ones, also for light that few unguided samples would find (docs/design/guiding.md, "auto").
///
/// `moment` is the sum over all contributions of the increase of the squared total, times that probability ratio; its
/// expectation is exactly the second moment of unguided samples.
class UnguidedEstimate {
  public:
    /// Continues along a direction, with the guided and unguided density; or through roulette, with the two survival
    /// probabilities.
    void step(float guided, float unguided) { ratio_ = unguided > 0.0f ? ratio_ * (guided / unguided) : 0.0f; }
    /// Continues as one of several split paths; unguided paths are never split.
    void split(float paths) { ratio_ *= paths; }

    /// Throughput of the unguided path over that of the guided one; 0: there is no unguided path.
    float ratio() const { return ratio_; }
    /// Probability of the unguided path over that of the guided one.
    float chance() const { return ratio_ > 0.0f ? 1.0f / ratio_ : 0.0f; }

    /// Adds a contribution of the guided path, weighted as in the unguided one, in any unit.
    void add(float light) {
        const float carried = light * ratio_;
        if (!std::isfinite(carried)) return;
        moment_ += (2.0f * found_ + carried) * light;
        found_ += carried;
    }
    /// Adds a cost in rays: traced rays, or other work expressed in rays.
    void add_cost(float rays) { cost_ += rays * chance(); }

    float moment() const { return moment_; }
    float cost() const { return cost_; }

    /// Estimate for a path that is split off: it starts with the luminance found so far, but with moment and cost 0,
    /// since the original path's estimate counts those.
    UnguidedEstimate split_off() const {
        UnguidedEstimate estimate = *this;
        estimate.moment_ = estimate.cost_ = 0.0f;
        return estimate;
    }

  private:
    float ratio_ = 1.0f, found_ = 0.0f, moment_ = 0.0f, cost_ = 0.0f;
};

/// Estimate of unguided samples from a camera path and all of its split paths: second moment, and cost in rays.
struct UnguidedTotal {
    float moment = 0.0f, cost = 0.0f;

    void add(const UnguidedTotal& other) {
        moment += other.moment;
        cost += other.cost;
    }
    /// Adds the other branch at glass; `product`: twice the product of both branches' luminances.
    void add(const UnguidedEstimate& branch, float product) {
        moment += branch.moment() + product;
        cost += branch.cost();
    }
};

}  // namespace treefarm
