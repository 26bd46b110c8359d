// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/mpi/program.h"

namespace treefarm::test {
namespace {

TEST(MpiChannel, MessagesOfAnySizeArriveWholeAndInOrder) {
    for (const std::vector<std::string>& transport :
         {std::vector<std::string>{}, std::vector<std::string>{"--mca", "btl", "tcp,self"}}) {
        const Ending ending =
            Program(mpirun(3, transport) + std::vector<std::string>{TREEFARM_CHANNEL_CHILD}).wait(240);
        EXPECT_EQ(ending.code, 0) << ending.output;
        for (const char* line :
             {"worker 1: 9 messages came back", "worker 2: 9 messages came back", "2 workers on this host"})
            EXPECT_NE(ending.output.find(line), std::string::npos) << line << " is missing in: " << ending.output;
    }
}

}  // namespace
}  // namespace treefarm::test
