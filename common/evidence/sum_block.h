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

/// Rows of a block, from `begin` on, without `end`; all by default.
struct RowRange {
    std::size_t begin = 0, end = ~std::size_t{0};
};

/// What is merged: a message of a worker, to which the limits of messages apply, or the total of several.
enum class EvidencePart : bool { message, total };

/// Block of exact sums, row by row.
class SumBlock {
  public:
    explicit SumBlock(const BlockShape& shape);

    const BlockShape& shape() const { return shape_; }
    std::size_t rows() const { return values_.size() / width(); }
    const LargeTable<std::uint64_t>& values() const { return values_; }
    std::span<const std::uint64_t> row(std::size_t row) const { return {values_.data() + row * width(), width()}; }
    /// A sum of a block of signed sums.
    double signed_value(std::size_t index) const {
        return static_cast<double>(values_[2 * index]) - static_cast<double>(values_[2 * index + 1]);
    }
    /// Number of sums that have reached 2^64 - 1.
    std::uint64_t saturated() const;

    /// Adds to a sum. False if it exceeds 2^64 - 1, where it stays.
    bool add(std::size_t index, std::uint64_t value) { return add_saturating(values_[index], value); }
    /// Adds to a sum of a block of signed sums.
    void add_signed(std::size_t index, std::int64_t value) {
        const auto bits = static_cast<std::uint64_t>(value);
        add(2 * index + (value < 0), value < 0 ? 0 - bits : bits);
    }
    void prefetch(std::size_t index) const { prefetch_line(values_.data() + index); }

    /// Makes a block whose rows grow have at least so many.
    void grow(std::size_t rows);
    void clear();
    /// Adds the sums of a block of the same shape.
    void add(const SumBlock& other);

    /// Writes the sums of some rows, for blocks of fixed size those that are not zero. The parts of disjoint ranges,
    /// merged, are the block.
    void write(ByteWriter& out, RowRange range = {}) const;
    /// Reads what write() wrote, without adding it. Throws FormatError if it does not fit.
    void check(ByteReader& in, EvidencePart part = EvidencePart::message) const;
    /// Adds what check() accepted. Returns the number of sums that it had.
    std::uint64_t merge(ByteReader& in);

    bool operator==(const SumBlock&) const = default;

  private:
    template <class Grow, class Visit>
    void read(ByteReader& in, Grow grow, Visit visit) const;
    [[noreturn]] void refuse(const std::string& what) const;
    bool grows() const { return shape_.rows == kGrowingRows; }
    /// Stored sums per row: signed ones are pairs of a positive and a negative sum.
    std::size_t width() const { return shape_.kind == BlockKind::signed_sums ? 2 * shape_.columns : shape_.columns; }

    BlockShape shape_;
    LargeTable<std::uint64_t> values_;
};

}  // namespace treefarm
