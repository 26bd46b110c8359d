// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "common/evidence/chosen_block.h"
#include "common/evidence/owned_block.h"
#include "common/evidence/sum_block.h"

namespace treefarm {

/// Blocks of one owner: of a guide, of an estimator, of the decisions. Parts of different work units merge in any order
/// to the same bits.
class Blocks {
  public:
    Blocks() = default;
    /// Empty blocks. `key`: of the hash that chooses records; the pass's number.
    explicit Blocks(std::span<const BlockShape> shapes, std::uint64_t key = 0);

    /// The block of this number among those of its kind, in the order of the declarations; sums of either sign are one
    /// kind.
    SumBlock& sums(std::size_t number) { return sums_[number]; }
    const SumBlock& sums(std::size_t number) const { return sums_[number]; }
    ChosenBlock& chosen(std::size_t number) { return chosen_[number]; }
    const ChosenBlock& chosen(std::size_t number) const { return chosen_[number]; }
    OwnedBlock& owned(std::size_t number) { return owned_[number]; }
    const OwnedBlock& owned(std::size_t number) const { return owned_[number]; }

    /// Number of sums that have reached 2^64 - 1.
    std::uint64_t saturated() const;

    void clear();
    /// Adds blocks of the same shapes and key. Throws RunError for others, and for rows that both have.
    void add(const Blocks& other);

    void write(ByteWriter& out) const;
    /// Reads what write() wrote, without adding it. Throws FormatError if it does not fit.
    void check(ByteReader& in, EvidencePart part = EvidencePart::message) const;
    /// Adds what check() accepted. Returns the number of entries that it had in the first block of sums.
    std::uint64_t merge(ByteReader& in);

    bool operator==(const Blocks&) const = default;

  private:
    std::vector<SumBlock> sums_;
    std::vector<ChosenBlock> chosen_;
    std::vector<OwnedBlock> owned_;
};

}  // namespace treefarm
