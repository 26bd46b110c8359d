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
    std::optional<PassPlan> pass;  ///< none: the render is done
    std::uint32_t spp_total = 0;   ///< expected when all is done; 0: not known yet
    std::size_t pass_count = 0;    ///< 0: not known yet
    BudgetMemory memory{};         ///< for RenderHistory::budget, once the pass is finished
};

/// Chooses the next pass. Pure. The only place where clock and estimated error have a say.
using PassChooser = std::function<NextPass(const RenderHistory&)>;

/// The passes of a list, one after the other.
PassChooser listed_passes(std::vector<PassPlan> passes);

/// Passes that double until budget.seconds, budget.error or budget.max_spp is near, then one that takes the rest, then
/// as many smaller ones as make up for what the forecast missed (none where the image is its last pass alone).
PassChooser open_passes(const Resolved& job);

/// The passes that the job itself asks for; after those that were `begun`, as continued_passes() has it.
PassChooser passes_of(const Resolved& job, std::span<const PassPlan> begun = {});

/// All passes of a render of budget.spp that has finished those of `begun` so far: plan_passes(), if these begin it;
/// otherwise passes go on doubling from there by the same two rules (docs/use/resume.md). Pure.
std::vector<PassPlan> continued_passes(const Resolved& job, std::span<const PassPlan> begun);

/// Lets a pass's light paths start by what those of the passes before brought, where the job has it so. Whoever renders
/// a pass sets it once, as its kernel.
void set_emission(PassPlan& pass, const Resolved& job, const RenderHistory& state);

/// A finished pass; `before`: the one before it, or nullptr.
PassResult finished_pass(const PassPlan& plan, const PassPlan* before, std::vector<PixelEstimate> pixels);

/// Adds a finished pass to those that make the image. Passes that it replaces leave.
void show(PassResult pass, const Resolved& job, std::vector<PassResult>& shown);

/// Whether the job asked for an error that the image has not come down to.
bool misses_target(const Job& job, const ErrorEstimate& error);

}  // namespace treefarm
