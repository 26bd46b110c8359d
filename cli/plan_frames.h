// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "cli/plan_answer.h"

namespace treefarm {

/// A probed frame of a shot.
struct ProbedFrame {
    std::size_t index = 0;  ///< among the shot's frames
    int number = 0;
    Resolved job;
    PlanAnswer answer;
};

/// Indices of the first, middle and last of so many frames, each once.
std::vector<std::size_t> frames_to_probe(std::size_t count);

/// Seconds of all frames: those between two probed ones by linear interpolation. Probes are taken to be wrong alike, so
/// the bounds add up. `probed` is not empty, its answers are known.
Expected seconds_of_frames(const std::vector<ProbedFrame>& probed, std::size_t count);

/// Answer for a shot in words, and a line per probed frame; as JSON.
std::string frames_text(const std::vector<ProbedFrame>& probed, std::size_t count);
nlohmann::ordered_json frames_json(const std::vector<ProbedFrame>& probed, std::size_t count);

}  // namespace treefarm
