// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "common/base/bytes.h"
#include "common/evidence/block_shape.h"

namespace treefarm {

/// Block of records, of which at most a capacity is kept: those with the smallest keyed hashes. That set of a union is
/// the set of the parts' sets, so the result does not depend on who met a record first; each record has the same
/// probability of being kept. Records are ordered when they are read: not even const members are thread-safe.
class ChosenBlock {
  public:
    /// `key` of the hash: another one chooses other records.
    ChosenBlock(const BlockShape& shape, std::uint64_t key);

    const BlockShape& shape() const { return shape_; }
    std::size_t capacity() const { return shape_.rows; }

    /// Offers a record. Its `name` is unique in the pass: of a path vertex, made of pixel, sample and number. Throws
    /// RunError for another number of words.
    void offer(std::uint64_t name, std::span<const std::uint32_t> words);

    /// Number of kept records; they are ordered by hash.
    std::size_t size() const;
    std::uint64_t name(std::size_t record) const;
    std::span<const std::uint32_t> words(std::size_t record) const;
    /// Probability, in (0, 1], with which any record was kept: a record stands for 1 / kept_share() records.
    double kept_share() const;

    void clear() { records_.clear(), words_.clear(), is_sorted_ = true; }
    /// Adds the records of a block of the same shape and key.
    void add(const ChosenBlock& other);

    void write(ByteWriter& out) const;
    /// Reads what write() wrote, without adding it. Throws FormatError if it does not fit, or has a record that is kept
    /// already.
    void check(ByteReader& in) const;
    /// Adds what check() accepted. Returns the number of records.
    std::uint64_t merge(ByteReader& in);

    bool operator==(const ChosenBlock& other) const;

  private:
    struct Record {
        std::uint64_t hash, name;
        std::size_t words;  ///< index of the first in `words_`

        bool operator<(const Record& other) const { return hash != other.hash ? hash < other.hash : name < other.name; }
    };
    std::uint64_t hash(std::uint64_t name) const;
    /// Kept records: one more than the capacity, since the hash of that one tells kept_share().
    std::size_t most() const { return shape_.rows + 1; }
    /// Cuts the records to most() and orders them.
    void cut() const;

    BlockShape shape_;
    std::uint64_t key_;
    mutable std::vector<Record> records_;  ///< cut and ordered when they are read
    mutable std::vector<std::uint32_t> words_;
    mutable bool is_sorted_ = true;
};

}  // namespace treefarm
