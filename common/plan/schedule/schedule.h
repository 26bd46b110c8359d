// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "common/decide/pass/pass_plan.h"
#include "common/plan/resolve/resolve.h"

namespace treefarm {

/// Work units of a pass, in order of issue: tiles row by row, then ranges.
std::vector<WorkUnit> cut_pass(const PassPlan& pass, int width, int height, int tile_size);

/// The pass of a job at this position of the schedule. `last`: no later pass could learn from it.
PassPlan make_pass(const Resolved& job, std::uint32_t index, std::uint32_t first_sample, std::uint32_t spp, bool last);

/// Sets next_event or record, and the members that depend on it.
void set_next_event(PassPlan& pass, const Resolved& job, bool next_event);
void set_record(PassPlan& pass, const Resolved& job, bool record);

/// Passes of a job. They double from guiding.spp_unit; if the rest after a pass would be less than twice that pass, the
/// pass takes the rest. The budget is rounded up to whole units. For an open budget (budget.seconds, budget.error),
/// whose passes are chosen one by one (budget.h), a guess for planning: those of budget.spp, at least 64. Pure.
std::vector<PassPlan> plan_passes(const Resolved& job);

/// Length of pass number `index` if `remaining` is left, both in guiding.spp_unit.
std::uint32_t next_units(std::uint32_t index, std::uint32_t remaining);

/// Whether clock or estimated error choose the passes.
bool has_open_budget(const Resolved& job);

/// Factor sqrt(n_k / 4) by which split thresholds grow up to pass k. n_k is the length by doubling, spp_unit 2^k, even
/// if the last pass is longer, as in the authors' program.
double split_growth(const Resolved& job, const PassPlan& coming_pass);

/// Threshold c sqrt(n_k / 4): records above which a region splits before pass k.
double spatial_split_threshold(const Resolved& job, const PassPlan& coming_pass);

}  // namespace treefarm
