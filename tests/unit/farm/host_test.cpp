// SPDX-License-Identifier: Apache-2.0
#include "common/base/host.h"

#include <gtest/gtest.h>

#include "coordinator/farm/memory_check.h"
#include "tests/support/refusal.h"

namespace treefarm {
namespace {

constexpr std::uint64_t kGigabyte = 1'000'000'000;

MemoryPlan plan(std::uint64_t worker, std::uint64_t film) {
    MemoryPlan plan;
    plan.worker.push_back({"tree", worker, ""});
    plan.coordinator.push_back({"scene", 1000 * kGigabyte, ""});  // there already
    plan.coordinator.push_back({"film", film, ""});
    return plan;
}

Hello hello(const std::string& host, std::uint64_t memory) {
    Hello hello;
    hello.host = host;
    hello.memory = memory;
    hello.threads = 1;
    return hello;
}

/// The message by which hosts are refused; "" where none is.
std::string refusal(const MemoryPlan& plan, const Host& own, const std::vector<Hello>& workers) {
    Roster roster(1);
    for (std::size_t k = 0; k < workers.size(); ++k)
        roster.admit(static_cast<int>(k) + 1, workers[k], 0);
    return test::refusal_of([&] { check_memory(plan, own, roster, "scene.xml"); });
}

TEST(Host, KnowsItself) {
    const Host host = this_host();
    EXPECT_FALSE(host.name.empty());
    EXPECT_GT(host.available_bytes, 1'000'000u);
}

TEST(MemoryCheck, SumsOverTheProcessesOfAHost) {
    const Host own{"a", 10 * kGigabyte};
    const MemoryPlan each = plan(3 * kGigabyte, 3 * kGigabyte);
    EXPECT_EQ(refusal(each, own, {}), "");
    EXPECT_EQ(refusal(each, own, {hello("a", 1), hello("a", 1)}), "") << "what workers of this host saw is older";
    EXPECT_EQ(refusal(each, own, {hello("b", 3 * kGigabyte), hello("c", 3 * kGigabyte)}), "");
    const std::string here = refusal(each, own, {hello("a", 1), hello("a", 1), hello("a", 1)});
    EXPECT_NE(here.find("on a, by the coordinator and 3 workers"), std::string::npos) << here;
    EXPECT_NE(here.find("12 GB"), std::string::npos) << here;
    EXPECT_NE(here.find("10 GB"), std::string::npos) << here;
    EXPECT_NE(here.find("farm.memory_check=false"), std::string::npos) << here;
    const std::string there = refusal(each, own, {hello("b", 5 * kGigabyte), hello("b", 6 * kGigabyte)});
    EXPECT_NE(there.find("on b, by 2 workers"), std::string::npos) << there;
    EXPECT_NE(there.find("5 GB are available"), std::string::npos) << there;
}

TEST(MemoryCheck, AGuestsWordsAreHeldAgainstNobodyElse) {
    Roster roster(1);
    roster.admit(1, hello("b", 8 * kGigabyte), 0);
    for (int guest = 2; guest < 9; ++guest)
        roster.admit(guest, hello(guest % 2 ? "a" : "b", 1), 0).is_guest = true;
    EXPECT_EQ(test::refusal_of([&] {
                  check_memory(plan(3 * kGigabyte, kGigabyte), {"a", 4 * kGigabyte}, roster, "scene.xml");
              }),
              "");
}

TEST(MemoryCheck, HoldsNothingUnknownAgainstAnybody) {
    const MemoryPlan much = plan(1000 * kGigabyte, 1000 * kGigabyte);
    EXPECT_EQ(refusal(much, {"a", 0}, {hello("a", 0), hello("b", 0)}), "");
    EXPECT_NE(refusal(much, {"a", 1}, {}), "");
}

}  // namespace
}  // namespace treefarm
