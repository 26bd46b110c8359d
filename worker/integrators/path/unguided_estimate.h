// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace treefarm {

/// A guided path as the unguided path that it might have been. It has the same directions; unguided they are as likely
/// as 1 / ratio says, and carry `ratio` times as much. So guided samples tell how noisy and how costly unguided ones
/// would be, also by light that few unguided samples meet (docs/design/guiding.md, "auto").
///
/// The expectation of `moment`, the sum over all contributions of what each adds to the square of what was found so
/// far, times that likelihood, is the second moment of unguided samples exactly.
class UnguidedEstimate {
  public:
    /// Goes on along a direction, with the densities that guided and unguided paths draw it with, or through roulette,
    /// with the chances that they survive it.
    void step(float guided, float unguided) { ratio_ = unguided > 0.0f ? ratio_ * (guided / unguided) : 0.0f; }
    /// Goes on as one of several paths, which unguided paths never do.
    void split(float paths) { ratio_ *= paths; }

    /// What the unguided path would carry over what the guided one does; 0: there is none.
    float ratio() const { return ratio_; }
    /// How likely the unguided path is, over the guided one.
    float chance() const { return ratio_ > 0.0f ? 1.0f / ratio_ : 0.0f; }

    /// Contribution of the guided path, weighted as the unguided one would weigh it, at any scale.
    void add(float light) {
        const float carried = light * ratio_;
        if (!std::isfinite(carried)) return;
        moment_ += (2.0f * found_ + carried) * light;
        found_ += carried;
    }
    /// Rays that were traced, or what stands for as many.
    void add_cost(float rays) { cost_ += rays * chance(); }

    float moment() const { return moment_; }
    float cost() const { return cost_; }

    /// The twin of one of the paths that a split path goes on as: it has found what the path has, but its moment and
    /// cost begin at 0, since the path's own twin counts those.
    UnguidedEstimate split_off() const {
        UnguidedEstimate estimate = *this;
        estimate.moment_ = estimate.cost_ = 0.0f;
        return estimate;
    }

  private:
    float ratio_ = 1.0f, found_ = 0.0f, moment_ = 0.0f, cost_ = 0.0f;
};

/// What a camera path tells of unguided ones, with all the paths that it left: second moment, and cost in rays.
struct UnguidedTotal {
    float moment = 0.0f, cost = 0.0f;

    void add(const UnguidedTotal& other) {
        moment += other.moment;
        cost += other.cost;
    }
    /// One more way out of glass, and twice the product of what both ways found.
    void add(const UnguidedEstimate& branch, float product) {
        moment += branch.moment() + product;
        cost += branch.cost();
    }
};

}  // namespace treefarm
