// SPDX-License-Identifier: Apache-2.0
// Work cut into parts that run side by side.
#include "common/base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>

namespace treefarm::test {
namespace {

TEST(InParts, CoverEachElementOnce) {
    for (const std::size_t count : {0u, 1u, 63u, 64u, 65u, 1000u, 4099u}) {
        std::vector<std::atomic<int>> seen(count);
        in_parts(count, 64, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                ++seen[i];
        });
        for (std::size_t i = 0; i < count; ++i)
            EXPECT_EQ(seen[i], 1) << i << " of " << count;
    }
}

TEST(InParts, NoneIsSmallerThanAsked) {
    std::atomic<int> parts = 0;
    in_parts(100, 60, [&](std::size_t begin, std::size_t end) {
        ++parts;
        EXPECT_EQ(end - begin, 100u);
    });
    EXPECT_EQ(parts, 1);
}

TEST(InParts, WhatAPartThrowsArrives) {
    for (const std::size_t bad : {0u, 4095u})
        EXPECT_THROW(in_parts(4096, 64,
                              [&](std::size_t begin, std::size_t end) {
                                  if (begin <= bad && bad < end) throw std::runtime_error("bad");
                              }),
                     std::runtime_error);
}

}  // namespace
}  // namespace treefarm::test
