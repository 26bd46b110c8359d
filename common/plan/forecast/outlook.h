// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "common/film/error_estimate.h"
#include "common/plan/schedule/schedule.h"

namespace treefarm {

/// Facts about a finished pass that tell of those to come. Seconds of the clock are the coordinator's.
struct PassFacts {
    std::uint32_t spp = 0;
    std::uint32_t spp_before = 0;
    double mse_of_sample = 0;        ///< PassVariance::mse_of_sample
    double stuv_trimmed = 0;         ///< PassVariance::stuv_trimmed; 0: not known
    double collect_seconds = 0;      ///< of the clock: what grows with spp
    double overhead_seconds = 0;     ///< of the clock: what does not (broadcast, refinement, combination)
    double trace_core_seconds = 0;   ///< of the workers' threads, tracing
    double record_core_seconds = 0;  ///< of the workers' threads, adding records to the sums
    std::uint32_t threads = 0;       ///< of the workers that were there at its end; 0: not known
    bool record = false;             ///< taught the tree of the next pass; if not, the next has the same tree
    bool next_event = false;
};

/// What the choice of passes for an open budget remembers (budget.h).
struct BudgetMemory {
    bool probed = false;  ///< a short pass has tried the last tree
    bool ending = false;  ///< a pass was meant to be the last

    bool operator==(const BudgetMemory&) const = default;
};

/// A render between two passes: all that decides which comes next.
struct RenderHistory {
    std::vector<PassFacts> passes;  ///< the finished ones
    double seconds = 0;             ///< of the clock, rendering, in all lives of the render
    std::uint32_t threads = 0;      ///< of the workers that the next pass has; 0: not known
    ErrorEstimate error;            ///< of the image so far
    Guiding guiding = Guiding::open;
    bool splitting = true;       ///< may pay
    bool light_subpaths = true;  ///< may pay
    EmissionSums emission;       ///< of all passes
    BudgetMemory budget;         ///< with the last finished pass: NextPass::memory of it

    std::uint32_t spp() const { return passes.empty() ? 0 : passes.back().spp_before + passes.back().spp; }
    /// Samples per pixel of the passes that had the last one's tree.
    std::uint32_t spp_of_last_tree() const;
};

/// Forecast of coming passes, by those that are done (docs/design/error.md, "error"). A tree that learns more makes
/// samples less noisy and changes what they cost, each time by less than the time before: its progress to the power
/// 3/4, the change of cost to the power 0.35. Needs a finished pass.
class Outlook {
  public:
    explicit Outlook(const RenderHistory& state);

    /// Whether any pass tells the variance of its samples.
    bool knows_variance() const { return variance_ > 0 || quiet_; }
    /// Variance of one sample, as samples are now: what the last trees measured together, as far as they show no
    /// progress. Progress is seen without the worst pixels, in which a rare sample tells nothing of the tree.
    double variance() const { return variance_; }
    /// Variance of one sample once `trees` more trees were learned; variance() where nothing is learned any more.
    double variance_after(int trees) const;
    /// Progress by the last tree that brought any: variance over that before it, at most 1. 1 as well where none of the
    /// last three did. 0: not known yet.
    double progress() const { return progress_; }
    /// Progress by the last two trees together. 0: fewer than three were seen.
    double recent_progress() const { return recent_progress_; }
    /// Whether the next pass has another tree than the last.
    bool learning() const { return learning_; }

    /// Seconds of the clock for a sample per pixel, once `trees` more trees were learned.
    double seconds_per_spp(int trees, bool record) const;
    double overhead_seconds() const { return overhead_; }

  private:
    void look_at_variance(const RenderHistory& state);
    void look_at_cost(const RenderHistory& state);

    bool learning_ = false;
    bool quiet_ = false;  ///< passes with a variance of zero
    double variance_ = 0, progress_ = 0, recent_progress_ = 0;
    int trees_since_ = 0;                       ///< without progress
    double core_per_spp_ = 0, cost_ratio_ = 1;  ///< without recording; of the last tree over that before it
    double recording_ = 1;                      ///< core-seconds with it over those without
    double clock_per_core_ = 1;
    double overhead_ = 0;
};

}  // namespace treefarm
