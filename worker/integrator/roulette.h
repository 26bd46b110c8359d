#pragma once

#include <algorithm>
#include <cstdint>

#include "common/math/vec.h"

namespace treefarm {

/// Russian roulette by throughput, as the authors' program plays it (docs/guiding.md, "PPG as its program does it").
class Roulette {
  public:
    enum class Rule : std::uint8_t {
        unguided,   ///< survival min(throughput, 0.95)
        untrained,  ///< a guided render before its first tree: throughput, within [0.1, 0.99]
        trained,    ///< 0.99: the guide sends paths where they matter
    };

    Roulette(Rule rule, int first_depth) : rule_(rule), first_depth_(first_depth) {}

    /// Whether a path that scattered at `depth` (1 at the first surface) has to play.
    bool plays(int depth) const { return depth >= first_depth_; }

    /// `scale` (above 0): of the throughput as roulette sees it, without what refraction takes and gives back.
    float survival(const Rgb& throughput, float scale = 1.0f) const {
        switch (rule_) {
            case Rule::unguided:
                return std::min(max_component(throughput) * scale, 0.95f);
            case Rule::untrained:
                return std::clamp(max_component(throughput) * scale, 0.1f, 0.99f);
            case Rule::trained:
                break;
        }
        return 0.99f;
    }

  private:
    Rule rule_;
    int first_depth_;
};

}  // namespace treefarm
