// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <span>
#include <vector>

#include "common/base/bytes.h"
#include "common/evidence/block_shape.h"

namespace treefarm {

/// Block of rows of words, such as a Markov chain's weight, each written once by the unit that owns it. Whoever
/// declares it checks that the rows of a message are those of its units.
class OwnedBlock {
  public:
    explicit OwnedBlock(const BlockShape& shape) : shape_(shape) {}

    const BlockShape& shape() const { return shape_; }

    /// Sets a row. Throws RunError if it is set already, out of range, of another size, or has too large a word.
    void set(std::size_t row, std::span<const std::uint64_t> words);
    /// Words of a row; empty if it is not set.
    std::span<const std::uint64_t> row(std::size_t row) const;
    std::size_t size() const { return rows_.size(); }

    void clear() { rows_.clear(); }
    /// Adds the rows of a block of the same shape. Throws RunError if both have a row.
    void add(const OwnedBlock& other);

    void write(ByteWriter& out) const;
    /// Reads what write() wrote, without adding it. Throws FormatError if it does not fit, or has a row that is set
    /// already.
    void check(ByteReader& in) const;
    /// Adds what check() accepted. Returns the number of rows.
    std::uint64_t merge(ByteReader& in);

    bool operator==(const OwnedBlock&) const = default;

  private:
    BlockShape shape_;
    std::map<std::size_t, std::vector<std::uint64_t>> rows_;
};

}  // namespace treefarm
