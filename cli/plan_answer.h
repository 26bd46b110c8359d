// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "cli/probe.h"
#include "common/plan/forecast/expectation.h"

namespace treefarm {

/// The budget that ends a render which a plan looks at.
enum class RenderEnd : std::uint8_t { error, seconds, spp };

/// Expected cost and error of a render, by a probe.
struct PlanAnswer {
    Probe probe;
    Expectation expected;
    RenderEnd end = RenderEnd::spp;  ///< whichever of its budgets comes first
    double pixel_ratio = 1;          ///< of the render's film over the probe's
};

/// The answer by a probe, for the budget of the request's job.
PlanAnswer answer_by_probe(const Resolved& job, Probe probe, double pixel_ratio);

/// "5 % error: about 1,840 spp [1,500, 2,300], 2:10 min [1:40 min, 2:50 min] on this machine (2 threads)", and a line
/// about the probe.
std::string answer_text(const Resolved& job, const PlanAnswer& answer);
nlohmann::ordered_json answer_json(const PlanAnswer& answer);

/// "1,840".
std::string count_text(double count);

}  // namespace treefarm
