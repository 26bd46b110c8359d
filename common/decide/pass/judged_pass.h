// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "common/decide/pass/pass_plan.h"
#include "common/decide/pixels/image_levels.h"
#include "common/film/trace_counts.h"

namespace treefarm {

/// Techniques that a job leaves to finished passes: true if it is used only while it pays.
struct DecisionRules {
    bool guiding = false;
    bool splitting = false;
    bool next_event = false;  ///< decided is how often emitters are sampled
    bool light_subpaths = false;
};

/// A finished pass as all decisions see it; each sees its own sums besides.
struct JudgedPass {
    const PassPlan& plan;
    const TraceCounts& counts;
    DecisionRules rules{};
    double sample_cost = 0;                   ///< sample_cost()
    std::span<const PixelEstimate> pixels{};  ///< of the pass alone
    std::size_t width = 0;                    ///< of the image, pixels
    ImageLevels told{};                       ///< light levels by which the pass was traced
    ImageLevels levels{};                     ///< light levels of the image with this pass, if measures_noise()
    PassPlan next{};                          ///< next pass as decisions earlier in the list have changed it

    /// Whether noise of pixels relative to the light around them is measured.
    bool measures_noise() const { return (rules.guiding || rules.next_event) && plan.layers.estimates; }
};

}  // namespace treefarm
