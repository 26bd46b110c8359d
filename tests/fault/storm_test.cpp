// SPDX-License-Identifier: Apache-2.0
#include "tests/support/fault_storm.h"

namespace treefarm::test {
namespace {

TEST_F(FaultStorm, ARenderComesThroughWithItsBits) {
    const Count count = storm(150, 1);
    for (const int kind : {count.deaths, count.stops, count.cuts, count.leaves, count.late, count.crashes})
        EXPECT_GT(kind, 2);
    std::cout << renders() << " renders in " << lives() << " lives, " << count.all() << " faults\n";
}

}  // namespace
}  // namespace treefarm::test
