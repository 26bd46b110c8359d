// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "common/plan/schedule/schedule.h"

namespace treefarm {

/// Text of schedule.toml: one [[pass]] table per pass with the decisions (spp, next_event, record). All else follows
/// from the job, so job and schedule together repeat a render's bits.
std::string write_schedule(std::span<const PassPlan> passes);

/// Passes from the text of a schedule.toml; `name` stands for the file in messages. Throws InputError with
/// file:line:column.
std::vector<PassPlan> parse_schedule(const std::string& toml, const std::string& name, const Resolved& job);

}  // namespace treefarm
