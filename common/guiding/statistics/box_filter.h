// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "common/base/random.h"
#include "common/guiding/statistics/cell_sums.h"

namespace treefarm {

/// The box filter over directions: a square of the size of the record's cell around the record overlaps two by two
/// squares of the grid of that size. Each gets its share; where it is cut finer, at a point drawn from the overlap, so
/// that the expectation is that of the box. A block of records is cut side by side, in vector registers.
class BoxBlock {
  public:
    static constexpr std::uint32_t kRecords = 32;
    static constexpr std::uint32_t kParts = 4;

    /// `side` of the record's cell, in steps of the direction square; `exponent` of its distribution's quanta.
    void set(std::uint32_t i, const Record& record, std::uint32_t side, int exponent) {
        code_[i] = record.code;
        rounding_[i] = record.rounding;
        value_[i] = record.value;
        side_[i] = static_cast<std::int32_t>(side);
        per_value_[i] = exact_power_of_two(-exponent);
    }

    /// Cuts the first `count` records, all set. Returns how many parts were capped.
    std::uint64_t cut(std::uint32_t count);

    /// Part 0 lies in the record's own cell.
    std::uint64_t quanta(std::uint32_t part, std::uint32_t i) const {
        return static_cast<std::uint64_t>(static_cast<std::int64_t>(quanta_[part][i]));
    }
    /// Z-order code of the point of part 1, 2 or 3.
    std::uint32_t part_code(std::uint32_t part, std::uint32_t i) const { return part_code_[part][i]; }

  private:
    template <class T>
    using Lanes = std::array<T, kRecords>;

    void find_lines(std::uint32_t count);
    template <std::uint32_t kPart>
    std::uint64_t cut_part(std::uint32_t count);

    alignas(32) Lanes<std::uint32_t> code_{}, rounding_{};
    alignas(32) Lanes<float> value_{};
    alignas(32) Lanes<std::int32_t> side_{};
    alignas(32) Lanes<double> per_value_{};
    // Corner of the square, how much of it lies before the line of the grid that crosses it, and on which side the
    // record is.
    alignas(32) Lanes<std::int32_t> left_{}, top_{}, before_x_{}, before_y_{};
    alignas(32) Lanes<std::uint32_t> own_{};
    alignas(32) std::array<Lanes<double>, kParts> quanta_{};
    alignas(32) std::array<Lanes<std::uint32_t>, kParts> part_code_{};
};

}  // namespace treefarm
