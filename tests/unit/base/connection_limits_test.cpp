// SPDX-License-Identifier: Apache-2.0
#include "common/base/connection_limits.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <vector>

namespace treefarm {
namespace {

TEST(ConnectionLimits, TheOldestFromTheAddressWithMostGivesWay) {
    const auto closed = [](const std::vector<std::string>& addresses) { return connection_to_close(addresses); };
    EXPECT_EQ(closed({"a"}), 0u);
    EXPECT_EQ(closed({"a", "b", "c"}), 0u);
    EXPECT_EQ(closed({"a", "b", "c", "b"}), 1u);
    EXPECT_EQ(closed({"a", "b", "b", "a", "c", "a"}), 0u);
}

TEST(ConnectionLimits, TheLastDescriptorsAreForFiles) {
    rlimit before{};
    ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &before), 0);
    rlimit few = before;
    few.rlim_cur = 40;
    ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &few), 0);
    EXPECT_FALSE(is_kept_for_files(23));
    EXPECT_TRUE(is_kept_for_files(24));
    EXPECT_TRUE(is_kept_for_files(39));
    ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &before), 0);
}

}  // namespace
}  // namespace treefarm
