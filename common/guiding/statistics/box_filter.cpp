// SPDX-License-Identifier: Apache-2.0
#include "common/guiding/statistics/box_filter.h"

#include "common/math/direction_map.h"

namespace treefarm {
namespace {

constexpr std::int32_t kSteps = 1 << kDirectionBits;

/// All ones if the lowest bit is set, else 0.
std::int32_t mask_of(std::int32_t bit) {
    return -(bit & 1);
}

/// Code of a point of the direction square, in steps, possibly up to half the square beyond an edge: there the
/// octahedral map continues at the mirrored point of the same edge.
[[gnu::always_inline]] inline std::uint32_t folded_code(std::int32_t x, std::int32_t y) {
    const auto fold = [](std::int32_t& across, std::int32_t& along) {
        const std::int32_t beyond = mask_of(across >> kDirectionBits);
        across = (across ^ beyond) & (2 * kSteps - 1);  // -1 - across, or 2 * kSteps - 1 - across
        along = (along ^ beyond) + (beyond & kSteps);   // kSteps - 1 - along
    };
    fold(x, y);
    fold(y, x);
    return spread_bits(static_cast<std::uint32_t>(x)) | (spread_bits(static_cast<std::uint32_t>(y)) << 1);
}

/// Uniform position among `size` steps, from 16 random bits.
std::int32_t scaled(std::uint32_t random, std::int32_t size) {
    return static_cast<std::int32_t>(random * static_cast<std::uint32_t>(size) >> 16);
}

}  // namespace

std::uint64_t BoxBlock::cut(std::uint32_t count) {
    find_lines(count);
    return cut_part<0>(count) + cut_part<1>(count) + cut_part<2>(count) + cut_part<3>(count);
}

void BoxBlock::find_lines(std::uint32_t count) {
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto column = static_cast<std::int32_t>(compact_bits(code_[i]));
        const auto row = static_cast<std::int32_t>(compact_bits(code_[i] >> 1));
        left_[i] = column - (side_[i] >> 1);
        top_[i] = row - (side_[i] >> 1);
        before_x_[i] = side_[i] - (left_[i] & (side_[i] - 1));
        before_y_[i] = side_[i] - (top_[i] & (side_[i] - 1));
        own_[i] = (column >= left_[i] + before_x_[i] ? 1u : 0u) | (row >= top_[i] + before_y_[i] ? 2u : 0u);
    }
}

/// Parts are numbered from the record's own: across the vertical line, the horizontal one, or both.
template <std::uint32_t kPart>
std::uint64_t BoxBlock::cut_part(std::uint32_t count) {
    std::int32_t capped = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t part = own_[i] ^ kPart;
        const std::int32_t right = mask_of(static_cast<std::int32_t>(part));
        const std::int32_t lower = mask_of(static_cast<std::int32_t>(part >> 1));
        const std::int32_t width = before_x_[i] + (right & (side_[i] - 2 * before_x_[i]));
        const std::int32_t height = before_y_[i] + (lower & (side_[i] - 2 * before_y_[i]));
        const float per_step = value_[i] / (static_cast<float>(side_[i]) * static_cast<float>(side_[i]));
        const float value = per_step * (static_cast<float>(width) * static_cast<float>(height));
        quanta_[kPart][i] = whole_quanta(value, per_value_[i], scrambled(rounding_[i], 2 * part + 2));
        capped += quanta_[kPart][i] >= kMostQuanta;
        if constexpr (kPart != 0) {
            const std::uint32_t random = scrambled(rounding_[i], 2 * part + 1);
            part_code_[kPart][i] = folded_code(left_[i] + (right & before_x_[i]) + scaled(random & 0xffffu, width),
                                               top_[i] + (lower & before_y_[i]) + scaled(random >> 16, height));
        }
    }
    return static_cast<std::uint64_t>(capped);
}

}  // namespace treefarm
