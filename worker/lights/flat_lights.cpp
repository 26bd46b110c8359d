// SPDX-License-Identifier: Apache-2.0
#include "worker/lights/flat_lights.h"

#include <algorithm>
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

void FlatLights::pick(FlatBatch& b) const {
    const std::uint32_t points = whole_lanes(b.count);
    // Summed in the order of Widths, over all lanes of a block; unused lanes have 0.
    alignas(64) std::array<FlatBatch::Points<float>, kLanes> brings;
    alignas(64) FlatBatch::Points<float> scale;
    const std::size_t blocks = (count_ + LightLanes::kCount - 1) / LightLanes::kCount;
    const LightSpace space = space_;
    for (std::uint32_t i = 0; i < points; ++i) {
        const Vec3 p = space.normalised({b.x[i], b.y[i], b.z[i]});
        b.x[i] = p.x;
        b.y[i] = p.y;
        b.z[i] = p.z;
    }
    for (std::size_t k = 0; k < blocks * LightLanes::kCount; ++k) {
        const LightLane light = lanes_[k / LightLanes::kCount][static_cast<int>(k % LightLanes::kCount)];
        if (k >= count_) {
            std::fill_n(brings[k].begin(), points, 0.0f);
            continue;
        }
        for (std::uint32_t i = 0; i < points; ++i)
            brings[k][i] =
                light_estimate(light, b.x[i], b.y[i], b.z[i], b.nx[i], b.ny[i], b.nz[i], b.one_sided[i] != 0);
    }
    for (std::uint32_t i = 0; i < b.count; ++i)
        scale[i] = estimated_part(b.learned[i]);
    for (std::uint32_t i = 0; i < points; ++i) {
        const auto sum = [&](std::size_t at) {
            return ((brings[at][i] + brings[at + 4][i]) + (brings[at + 2][i] + brings[at + 6][i])) +
                   ((brings[at + 1][i] + brings[at + 5][i]) + (brings[at + 3][i] + brings[at + 7][i]));
        };
        const float total = blocks > 1 ? sum(0) + sum(LightLanes::kCount) : sum(0);
        scale[i] = total > kLeastLight ? scale[i] / total : 0.0f;
    }
    for (std::size_t k = 0; k < count_; ++k)
        for (std::uint32_t i = 0; i < points; ++i)
            b.widths[k][i] = static_cast<std::int32_t>(brings[k][i] * scale[i] + fixed_[k]);
    for (std::uint32_t i = 0; i < b.count; ++i)
        if (const LightProbabilities* learned = b.learned[i])
            for (std::size_t k = 0; k < count_; ++k)
                b.widths[k][i] += static_cast<std::int32_t>(kLearned * static_cast<float>((*learned)[k + 1]));
    alignas(64) FlatBatch::Points<std::uint32_t> end{};
    std::fill_n(b.chosen.begin(), points, 0u);
    for (std::size_t k = 0; k < count_; ++k)
        for (std::uint32_t i = 0; i < points; ++i) {
            const auto width = static_cast<std::uint32_t>(b.widths[k][i]);
            const std::uint32_t beyond = b.bits[i] - end[i];  // huge if `bits` is below the interval
            end[i] += width;
            b.chosen[i] += end[i] <= b.bits[i];
            b.chosen_width[i] = beyond < width ? b.widths[k][i] : b.chosen_width[i];
        }
}

}  // namespace treefarm
