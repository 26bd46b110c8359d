// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "common/evidence/blocks.h"

namespace treefarm {

/// All that the work units of a pass teach besides the image, by owner. Its parts, in messages and in checkpoints, have
/// one form (docs/design/protocol.md, "evidence").
class Evidence {
  public:
    Evidence() = default;
    /// `owners`: empty blocks of each owner.
    Evidence(std::uint32_t pass, std::vector<Blocks> owners) : pass_(pass), owners_(std::move(owners)) {}

    const Blocks& of(std::size_t owner) const { return owners_.at(owner); }
    /// Moves out the blocks of an owner; once.
    Blocks take(std::size_t owner) { return std::move(owners_.at(owner)); }

    Bytes encode() const;
    /// Adds an encoded part. Everything is checked first: a part counts as a whole or throws FormatError. Returns by
    /// owner the number of entries of its first block of sums.
    std::vector<std::uint64_t> merge_encoded(std::span<const std::uint8_t> bytes,
                                             EvidencePart part = EvidencePart::message);

    bool operator==(const Evidence&) const = default;

  private:
    std::uint32_t pass_ = 0;
    std::vector<Blocks> owners_;
};

// Evidence whose owners keep their blocks.

Bytes encode_evidence(std::uint32_t pass, std::span<const Blocks* const> owners);
/// As Evidence::merge_encoded().
std::vector<std::uint64_t> merge_evidence(std::uint32_t pass, std::span<Blocks* const> owners,
                                          std::span<const std::uint8_t> bytes,
                                          EvidencePart part = EvidencePart::message);

}  // namespace treefarm
