// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace treefarm {

/// Ways to merge the parts of a block that different work units made. Each gives the same bits in any order.
enum class BlockKind : std::uint8_t {
    sums,         ///< whole numbers, added; a sum that reaches 2^64 - 1 stays there
    signed_sums,  ///< whole numbers of either sign, added
    chosen,       ///< records chosen by a keyed hash and cut to a capacity
    owned,        ///< rows of words, each written by the one unit that owns it
};

/// Number of rows of a block of sums that has as many as its largest part.
inline constexpr std::size_t kGrowingRows = ~std::size_t{0};

/// Declaration of a block: a part of what a pass teaches, by whoever needs it (docs/design/evidence.md).
struct BlockShape {
    std::string_view name;  ///< unique in its list; a literal, in messages of errors
    std::string_view unit;  ///< of an entry
    BlockKind kind = BlockKind::sums;
    std::size_t rows = 1;     ///< capacity of chosen records
    std::size_t columns = 1;  ///< sums or words per row
    /// Largest entry, by size, that one message may have. Of signed sums below 2^63 over the number of messages, so
    /// that no sum overflows.
    std::uint64_t most = ~std::uint64_t{0};

    bool operator==(const BlockShape&) const = default;
};

/// Limit of signed entries in one message: 2^14 messages of the largest one fit 64 bits.
inline constexpr std::uint64_t kMostSigned = std::uint64_t{1} << 49;

}  // namespace treefarm
