// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "common/plan/forecast/expectation.h"
#include "coordinator/render/probe.h"

namespace treefarm {

/// Budget that ends a planned render.
enum class RenderEnd : std::uint8_t { error, seconds, spp };

/// Expected cost and error of a render, from a probe.
struct PlanAnswer {
    Probe probe;
    Expectation expected;
    RenderEnd end = RenderEnd::spp;  ///< budget that is reached first
    double pixel_ratio = 1;          ///< pixels of the render's film over the probe's
};

/// Answer from a probe, for the budget of the request's job.
PlanAnswer answer_by_probe(const Resolved& job, Probe probe, double pixel_ratio);

/// Answer in words: "5 % error: about 1,840 spp [1,500, 2,300], 2:10 [1:40, 2:50]".
std::string answer_words(const Resolved& job, const PlanAnswer& answer);

/// answer_words() with the machine, what else is to be said, and a line about the probe.
std::string answer_text(const Resolved& job, const PlanAnswer& answer);
nlohmann::ordered_json answer_json(const PlanAnswer& answer);

/// Count in words: "1,840".
std::string count_text(double count);

/// Time with its interval: "2:10 [1:40, 2:50]".
std::string time_text(const Expected& seconds);

/// "on this machine (2 threads)"
std::string machine_text(const Probe& probe);

/// Figure with its interval as JSON.
nlohmann::ordered_json figure_json(const Expected& figure);

}  // namespace treefarm
