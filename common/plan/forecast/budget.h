// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "common/film/combine.h"
#include "common/plan/forecast/forecast.h"
#include "common/plan/schedule/schedule.h"

namespace treefarm {

/// The next pass of a render, or its end.
struct NextPass {
    std::optional<PassPlan> pass;  ///< empty: the render is finished
    std::uint32_t spp_total = 0;   ///< expected at the end; 0: unknown
    std::size_t pass_count = 0;    ///< 0: unknown
    BudgetMemory memory{};         ///< new RenderHistory::budget once the pass is finished
};

/// Chooses the next pass. Pure. Only here do clock and estimated error influence a render.
using PassChooser = std::function<NextPass(const RenderHistory&)>;

/// Chooser of the passes of a list, in order.
PassChooser listed_passes(std::vector<PassPlan> passes);

/// Chooser of passes that double until budget.seconds, budget.error or budget.max_spp is near, then one that takes the
/// rest, then smaller ones to correct the forecast (none if the image is its last pass alone).
PassChooser open_passes(const Resolved& job);

/// Chooser of the passes of a job. After the passes `begun`, those of continued_passes().
PassChooser passes_of(const Resolved& job, std::span<const PassPlan> begun = {});

/// All passes of a render of budget.spp whose passes so far are `begun`: plan_passes() if these are its beginning,
/// otherwise passes that double from there on by the same two rules (docs/use/resume.md). Pure.
std::vector<PassPlan> continued_passes(const Resolved& job, std::span<const PassPlan> begun);

/// A finished pass; `before`: the previous one, or nullptr.
PassResult finished_pass(const PassPlan& plan, const PassPlan* before, std::vector<PixelEstimate> pixels);

/// Adds a finished pass to the passes that make the image, and removes those that it replaces.
void show(PassResult pass, const Resolved& job, std::vector<PassResult>& shown);

/// Whether the image misses the error that the job asked for.
bool misses_target(const Job& job, const ErrorEstimate& error);

}  // namespace treefarm
