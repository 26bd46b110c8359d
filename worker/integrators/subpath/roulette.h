// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "common/base/policy.h"
#include "common/decide/splitting/splitting_constants.h"
#include "common/math/vec.h"

namespace treefarm {

/// Russian roulette (docs/design/guiding.md, "Roulette").
class Roulette {
  public:
    enum class Rule : std::uint8_t {
        unguided,   ///< survival min(2 throughput, 0.95)
        untrained,  ///< a guided render before its first tree: throughput, within [0.1, 0.99]
        constant,   ///< 0.99: the guide sends paths where they matter
        adjoint,    ///< by the path's expected contribution over that of its first vertex
    };

    Roulette(Rule rule, int first_depth) : rule_(rule), first_depth_(first_depth) {}

    /// Whether a path that scattered at `depth` (1 at the first surface) is subject to roulette.
    bool plays(int depth) const { return depth >= first_depth_; }

    /// Survival probability. `scale` (above 0): factor on the throughput that undoes the scaling by refraction.
    /// `brightness`: light here over that at the path's first vertex.
    float survival(const Rgb& throughput, float scale = 1.0f, float brightness = 1.0f) const {
        switch (rule_) {
            case Rule::unguided:
                return std::min(max_component(throughput) * scale * tuned<float>("walk.unguided_window"),
                                tuned<float>("walk.unguided_most"));
            case Rule::untrained:
                return std::clamp(max_component(throughput) * scale, tuned<float>("walk.untrained_least"),
                                  tuned<float>("walk.guided_survival"));
            case Rule::adjoint:
                return std::clamp(max_component(throughput) * scale * brightness * tuned<float>("walk.adjoint_window"),
                                  tuned<float>("walk.adjoint_least"), tuned<float>("walk.adjoint_most"));
            case Rule::constant:
                break;
        }
        return tuned<float>("walk.guided_survival");
    }

    /// Applies roulette to a path that scattered at `depth`, with a number in [0, 1): returns false if it ends, else
    /// divides the throughput by the survival probability. `scale` as in survival().
    bool spares(Rgb& throughput, float scale, int depth, float random) const {
        if (!plays(depth)) return true;
        const float chance = survival(throughput, scale);
        if (!(random < chance)) return false;
        throughput *= 1.0f / chance;
        return true;
    }

    /// Number of paths, at most `most`, into which a path splits. Above 1 if its expected contribution is several times
    /// its first vertex's; each path then has at least the policy's fraction of the latter. 1 unless adjoint.
    std::uint32_t splitting(const Rgb& throughput, float scale, float brightness, std::uint32_t most) const {
        if (rule_ != Rule::adjoint) return 1;
        const float paths = max_component(throughput) * scale * brightness *
                            (1.0f / tuned<policy::kSplitting, float>("splitting.least_share"));
        if (!(paths >= 2.0f)) return 1;
        return static_cast<std::uint32_t>(std::min(paths, static_cast<float>(most)));
    }

    bool needs_brightness() const { return rule_ == Rule::adjoint; }

  private:
    Rule rule_;
    int first_depth_;
};

}  // namespace treefarm
