// SPDX-License-Identifier: Apache-2.0
#include "tests/support/fault_storm.h"

namespace treefarm::test {
namespace {

TEST_F(FaultStorm, NineThousandFaults) {
    const Count count = storm(9000, 1000);
    std::cout << renders() << " renders in " << lives() << " lives: " << count.deaths << " deaths, " << count.stops
              << " stops, " << count.cuts << " cut cables, " << count.leaves << " leaves, " << count.late
              << " late workers, " << count.crashes << " crashes of the coordinator\n";
}

}  // namespace
}  // namespace treefarm::test
