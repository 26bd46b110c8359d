// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "common/base/random.h"
#include "common/guiding/statistics/cell_sums.h"

namespace treefarm {

/// Box filter over directions: a square around the record, of the size of its cell, overlaps two by two squares of the
/// grid of that size. Each part goes to one cell. Where cells are finer, it is the cell of a point drawn from the
/// overlap, so that the expectation is the box's. A block of records is processed side by side, in vector registers.
class BoxBlock {
  public:
    static constexpr std::uint32_t kRecords = 32;
    static constexpr std::uint32_t kParts = 4;

    /// `side`: side of the record's cell, in steps of the direction square; `exponent`: that of its distribution's
    /// quanta.
    void set(std::uint32_t i, const Record& record, std::uint32_t side, int exponent) {
        code_[i] = record.code;
        rounding_[i] = record.rounding;
        value_[i] = record.value;
        side_[i] = static_cast<std::int32_t>(side);
        per_value_[i] = exact_power_of_two(-exponent);
    }

    /// Divides the first `count` records, which must be set. Returns the number of capped parts.
    std::uint64_t cut(std::uint32_t count);

    /// Quanta of a part; part 0 is in the record's own cell.
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
    // Corner of the square, its extent before the grid line that crosses it, and the record's side of that line.
    alignas(32) Lanes<std::int32_t> left_{}, top_{}, before_x_{}, before_y_{};
    alignas(32) Lanes<std::uint32_t> own_{};
    alignas(32) std::array<Lanes<double>, kParts> quanta_{};
    alignas(32) std::array<Lanes<std::uint32_t>, kParts> part_code_{};
};

}  // namespace treefarm
