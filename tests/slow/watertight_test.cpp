// SPDX-License-Identifier: Apache-2.0
// A hundred million paths in closed rooms: minutes.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <thread>

#include "tests/support/closed_rooms.h"

namespace treefarm {
namespace {

class Watertight : public testing::TestWithParam<double> {};

/// The test of the same name in tests/stability, a hundred times as long.
TEST_P(Watertight, NoneOfAHundredMillionPathsLeavesAClosedRoom) {
    constexpr long kPaths = 100'000'000;
    std::vector<test::ClosedRoom> rooms = test::closed_rooms(GetParam());
    const unsigned threads = std::max(1u, std::thread::hardware_concurrency());
    const long each = kPaths / static_cast<long>(rooms.size() * threads) + 1;
    for (test::ClosedRoom& room : rooms) {
        const EmbreeScene geometry(std::move(room.shapes), "avx2", {}, true);
        std::atomic<long> lost = 0;
        std::vector<std::thread> workers;
        for (unsigned i = 0; i < threads; ++i)
            workers.emplace_back([&, i] { lost += test::escapes(geometry, room.at, each, 2, 1000 + i); });
        for (std::thread& worker : workers)
            worker.join();
        EXPECT_EQ(lost, 0) << room.name;
    }
}

INSTANTIATE_TEST_SUITE_P(Sizes, Watertight, testing::Values(1.0, 1000.0, 10000.0));

}  // namespace
}  // namespace treefarm
