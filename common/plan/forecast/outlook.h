// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "common/decide/decisions.h"
#include "common/film/error_estimate.h"
#include "common/plan/schedule/schedule.h"

namespace treefarm {

/// Facts about a finished pass for forecasts. Times are the coordinator's wall-clock seconds unless noted.
struct PassFacts {
    std::uint32_t spp = 0;
    std::uint32_t spp_before = 0;
    double mse_of_sample = 0;        ///< PassVariance::mse_of_sample
    double stuv_trimmed = 0;         ///< PassVariance::stuv_trimmed; 0: unknown
    double collect_seconds = 0;      ///< part that grows with spp
    double overhead_seconds = 0;     ///< part that does not (broadcast, refinement, combination)
    double trace_core_seconds = 0;   ///< core-seconds of tracing on the workers
    double record_core_seconds = 0;  ///< core-seconds of adding records to the sums on the workers
    std::uint32_t threads = 0;       ///< of the workers present at its end; 0: unknown
    bool record = false;             ///< taught the tree of the next pass; if not, the next has the same tree
    bool next_event = false;
};

/// Memory of the pass chooser for open budgets (budget.h).
struct BudgetMemory {
    bool probed = false;  ///< a short pass has tried the last tree
    bool ending = false;  ///< a pass was meant to be the last

    bool operator==(const BudgetMemory&) const = default;
};

/// State of a render between two passes: all inputs of the choice of the next pass.
struct RenderHistory {
    std::vector<PassFacts> passes;  ///< finished passes
    double seconds = 0;             ///< wall-clock seconds of rendering, in all lives of the render
    std::uint32_t threads = 0;      ///< of the workers for the next pass; 0: unknown
    ErrorEstimate error;            ///< of the image so far
    Decisions::Memories decisions;
    BudgetMemory budget;  ///< memory as of the last finished pass: its NextPass::memory

    std::uint32_t spp() const { return passes.empty() ? 0 : passes.back().spp_before + passes.back().spp; }
    /// Samples per pixel of the passes that had the last pass's tree.
    std::uint32_t spp_of_last_tree() const;
};

/// Forecast of further passes from the finished ones (docs/design/error.md, "error"). A tree that learns more makes
/// samples less noisy and changes their cost, each time by less: the progress is that of the step before to the power
/// 3/4, the change of cost to the power 0.35. Needs a finished pass.
class Outlook {
  public:
    explicit Outlook(const RenderHistory& state);

    /// Whether the variance of samples is known from a pass.
    bool knows_variance() const { return variance_ > 0 || quiet_; }
    /// Variance of one sample at present, measured by the last trees together, as far as they show no progress.
    /// Progress is measured without the worst pixels, in which a rare sample says nothing about the tree.
    double variance() const { return variance_; }
    /// Variance of one sample after `trees` further trees; equals variance() if nothing more is learned.
    double variance_after(int trees) const;
    /// Progress by the last tree that improved: its variance over that of the tree before, at most 1. Also 1 if none of
    /// the last three improved. 0: unknown.
    double progress() const { return progress_; }
    /// Progress by the last two trees together. 0: fewer than three trees so far.
    double recent_progress() const { return recent_progress_; }
    /// Whether the next pass has another tree than the last.
    bool learning() const { return learning_; }

    /// Wall-clock seconds per sample per pixel, after `trees` further trees.
    double seconds_per_spp(int trees, bool record) const;
    double overhead_seconds() const { return overhead_; }

  private:
    void look_at_variance(const RenderHistory& state);
    void look_at_cost(const RenderHistory& state);

    bool learning_ = false;
    bool quiet_ = false;  ///< passes with a variance of zero
    double variance_ = 0, progress_ = 0, recent_progress_ = 0;
    int trees_since_ = 0;                       ///< number of trees without progress
    double core_per_spp_ = 0, cost_ratio_ = 1;  ///< without recording; of the last tree over that before it
    double recording_ = 1;                      ///< core-seconds with recording over those without
    double clock_per_core_ = 1;
    double overhead_ = 0;
};

}  // namespace treefarm
