// SPDX-License-Identifier: Apache-2.0
#include "common/base/large_table.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <numeric>

namespace treefarm {
namespace {

TEST(LargeTable, FillsHugePagesFromTheirBeginning) {
    const LargeTable<std::uint64_t> table(kHugePage / 8, 7);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(table.data()) % kHugePage, 0u);
    EXPECT_EQ(std::accumulate(table.begin(), table.end(), std::uint64_t{0}), 7 * (kHugePage / 8));
}

/// A small table comes from another place than a large one, and goes back there.
TEST(LargeTable, GrowsAndShrinksAcrossTheSizeOfAPage) {
    LargeTable<std::uint32_t> table;
    for (std::uint32_t i = 0; i < 3 * kHugePage / 4; ++i)
        table.push_back(i);
    LargeTable<std::uint32_t> copy = table;
    copy.resize(100);
    copy.shrink_to_fit();
    table = std::move(copy);
    ASSERT_EQ(table.size(), 100u);
    EXPECT_EQ(table.back(), 99u);
}

TEST(LargeTable, RefusesMoreThanThereIs) {
    HugePages<std::uint64_t> pages;
    EXPECT_THROW(pages.allocate(~std::size_t{0} / 8), std::bad_alloc);
}

}  // namespace
}  // namespace treefarm
