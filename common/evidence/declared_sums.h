// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>

#include "common/evidence/sum_block.h"

namespace treefarm {

/// Requirements of sums that have names in the code and are a block in messages: whole numbers, which each() visits in
/// the order of the block's rows. A block whose rows grow needs resize(rows) and size().
template <class S>
concept DeclaredSums = std::default_initializable<S> && requires(S& sums, const S& others) {
    { S::kBlock } -> std::convertible_to<const BlockShape&>;
    S::each(sums, [](std::uint64_t&) {});
    S::each(others, [](std::uint64_t) {});
    sums.add(others);
};

/// Adds sums to their block.
template <DeclaredSums S>
void put_sums(const S& sums, SumBlock& block) {
    static_assert(S::kBlock.kind == BlockKind::sums);
    if constexpr (S::kBlock.rows == kGrowingRows) block.grow(sums.size());
    std::size_t index = 0;
    S::each(sums, [&](std::uint64_t sum) { block.add(index++, sum); });
}

/// Sums of a block.
template <DeclaredSums S>
S sums_of(const SumBlock& block) {
    S sums;
    if constexpr (S::kBlock.rows == kGrowingRows) sums.resize(block.rows());
    std::size_t index = 0;
    S::each(sums, [&](std::uint64_t& sum) { sum = block.values()[index++]; });
    return sums;
}

/// Number of sums that each() visits by default: the size of a block of fixed size.
template <DeclaredSums S>
constexpr std::size_t count_sums() {
    std::size_t count = 0;
    S sums{};
    S::each(sums, [&](std::uint64_t&) { ++count; });
    return count;
}

}  // namespace treefarm
