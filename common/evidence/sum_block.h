// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "common/base/bytes.h"
#include "common/base/large_table.h"
#include "common/base/prefetch.h"
#include "common/evidence/block_shape.h"
#include "common/math/saturating.h"

namespace treefarm {

/// Rows of a block, from `begin` on, without `end`.
struct RowRange {
    std::size_t begin = 0, end = kGrowingRows;
};

/// Block of exact sums, row by row.
class SumBlock {
  public:
    explicit SumBlock(const BlockShape& shape);

    const BlockShape& shape() const { return shape_; }
    std::size_t rows() const { return values_.size() / shape_.columns; }
    const LargeTable<std::uint64_t>& values() const { return values_; }
    std::span<const std::uint64_t> row(std::size_t row) const {
        return {values_.data() + row * shape_.columns, shape_.columns};
    }
    /// A sum of a block of signed sums.
    std::int64_t signed_value(std::size_t index) const { return static_cast<std::int64_t>(values_[index]); }

    /// Adds to a sum. False if it exceeds 2^64 - 1, where it stays.
    bool add(std::size_t index, std::uint64_t value) { return add_saturating(values_[index], value); }
    void add_signed(std::size_t index, std::int64_t value) { values_[index] += static_cast<std::uint64_t>(value); }
    void prefetch(std::size_t index) const { prefetch_line(values_.data() + index); }

    /// Number of rows of a block that grows.
    void grow(std::size_t rows);
    void clear();
    /// Adds the sums of a block of the same shape. Returns the number of sums that reached the largest integer now.
    std::uint64_t add(const SumBlock& other);

    /// Writes the sums of some rows that are not zero. The parts of disjoint ranges, merged, are the block.
    void write(ByteWriter& out, RowRange range = {}) const;
    /// Reads what write() wrote, without adding it. Throws FormatError if it does not fit.
    void check(ByteReader& in) const;
    /// Numbers of sums that a message had, and that it brought to the largest integer.
    struct Merged {
        std::uint64_t entries = 0, saturated = 0;
    };
    /// Adds what check() accepted.
    Merged merge(ByteReader& in);

    bool operator==(const SumBlock&) const = default;

  private:
    template <class Grow, class Visit>
    void read(ByteReader& in, Grow grow, Visit visit) const;
    std::uint64_t coded(std::size_t index) const;
    std::uint64_t decoded(std::uint64_t coded) const;
    [[noreturn]] void refuse(const std::string& what) const;
    bool grows() const { return shape_.rows == kGrowingRows; }
    bool is_signed() const { return shape_.kind == BlockKind::signed_sums; }

    BlockShape shape_;
    LargeTable<std::uint64_t> values_;
};

}  // namespace treefarm
