// SPDX-License-Identifier: Apache-2.0
#include "coordinator/launch/restart_count.h"

#include <algorithm>
#include <cmath>

namespace treefarm {

bool RestartCount::died(const AttemptReach& reach, const std::string& place) {
    // Finished renders of a series are not repeated, so that any number of them is progress.
    if (reach.checkpoint > best_.checkpoint || reach.passes > best_.passes || reach.renders > 0) places_.clear();
    best_.checkpoint = std::max(best_.checkpoint, reach.checkpoint);
    best_.passes = std::max(best_.passes, reach.passes);
    places_.push_back(place);
    ++all_;
    return in_a_row() <= most_fruitless_ && all_ <= most_;
}

double RestartCount::pause() const {
    constexpr double kLongest = 30.0;
    return std::min(kLongest, std::exp2(std::max(0, in_a_row() - 1)));
}

std::string RestartCount::common_place() const {
    const auto is_first = [this](const std::string& place) { return place == places_.front(); };
    return !places_.empty() && std::all_of(places_.begin(), places_.end(), is_first) ? places_.front() : "";
}

}  // namespace treefarm
