// SPDX-License-Identifier: Apache-2.0
#include "coordinator/launch/restart_count.h"

#include <algorithm>
#include <cmath>

namespace treefarm {

bool RestartCount::died(const AttemptReach& reach, const std::string& stage) {
    // Finished renders of a series are not repeated, so that any number of them is progress.
    if (reach.checkpoint > best_.checkpoint || reach.passes > best_.passes || reach.renders > 0) stages_.clear();
    best_.checkpoint = std::max(best_.checkpoint, reach.checkpoint);
    best_.passes = std::max(best_.passes, reach.passes);
    stages_.push_back(stage);
    ++all_;
    return in_a_row() <= most_fruitless_ && all_ <= most_;
}

double RestartCount::pause() const {
    constexpr double kLongest = 30.0;
    return std::min(kLongest, std::exp2(std::max(0, in_a_row() - 1)));
}

std::string RestartCount::common_stage() const {
    const auto is_first = [this](const std::string& stage) { return stage == stages_.front(); };
    return !stages_.empty() && std::all_of(stages_.begin(), stages_.end(), is_first) ? stages_.front() : "";
}

}  // namespace treefarm
