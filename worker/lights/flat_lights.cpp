// SPDX-License-Identifier: Apache-2.0
#include "worker/lights/flat_lights.h"

#include <cassert>

namespace treefarm {

FlatLights::FlatLights(std::span<const LightBounds> bounds, std::span<const double> shares)
    : space_(bounds), lane_(bounds.size(), static_cast<std::uint8_t>(kLanes)) {
    for (std::uint32_t entry = 0; entry < bounds.size(); ++entry) {
        if (!(shares[entry] > 0)) continue;
        assert(count_ < kMost);
        space_.set(lanes_[count_ / LightLanes::kCount], static_cast<int>(count_ % LightLanes::kCount), bounds[entry]);
        fixed_[count_] = static_cast<float>(shares[entry] * double(kDefensive) * double(kLightMargin) * kLightWhole);
        entry_[count_] = entry;
        lane_[entry] = static_cast<std::uint8_t>(count_++);
    }
}

}  // namespace treefarm
