// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace treefarm {

/// Ways to merge the parts of a block that different work units made. Each gives the same bits in any order.
enum class BlockKind : std::uint8_t {
    sums,         ///< whole numbers, added; a sum that reaches 2^64 - 1 stays there
    signed_sums,  ///< whole numbers of either sign: positive and negative ones are added apart, each as sums are
    chosen,       ///< records chosen by a keyed hash and cut to a capacity
    owned,        ///< rows of words, each written by the one unit that owns it
};

/// Declared number of rows of a block of sums that has as many as its largest part.
inline constexpr std::size_t kGrowingRows = ~std::size_t{0};

/// Declaration of a block: a part of what a pass teaches, by whoever needs it (docs/design/evidence.md).
struct BlockShape {
    std::string_view name;  ///< unique in its list; a literal, in messages of errors
    std::string_view unit;  ///< of an entry; for readers of the code
    BlockKind kind = BlockKind::sums;
    std::size_t rows = 1;     ///< of chosen records: the most that are kept
    std::size_t columns = 1;  ///< sums or words per row
    /// Largest sum or owned word that one message may have.
    std::uint64_t most = ~std::uint64_t{0};

    bool operator==(const BlockShape&) const = default;
};

}  // namespace treefarm
