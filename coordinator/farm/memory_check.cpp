// SPDX-License-Identifier: Apache-2.0
#include "coordinator/farm/memory_check.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "common/base/error.h"

namespace treefarm {

namespace {

struct HostNeed {
    std::uint64_t available = 0;  ///< 0: unknown
    std::uint64_t bytes = 0;
    int workers = 0;
    bool coordinator = false;
};

std::string gigabytes(std::uint64_t bytes) {
    return fmt::format("{:.3g} GB", 1e-9 * static_cast<double>(bytes));
}

std::string who(const HostNeed& need) {
    const std::string workers = need.workers == 0   ? ""
                                : need.workers == 1 ? "a worker"
                                                    : std::to_string(need.workers) + " workers";
    if (!need.coordinator) return workers;
    return workers.empty() ? "the coordinator" : "the coordinator and " + workers;
}

}  // namespace

std::uint64_t still_to_come(std::span<const MemoryItem> items) {
    std::uint64_t bytes = 0;
    for (const MemoryItem& item : items)
        if (item.name != "scene" && item.name != kProgramMemory) bytes += item.bytes;
    return bytes;
}

void check_memory(const MemoryPlan& plan, const Host& own, const Roster& roster, const std::string& scene) {
    std::map<std::string, HostNeed> hosts;
    hosts[own.name] = {own.available_bytes, still_to_come(plan.coordinator), 0, true};
    for (const auto& [peer, member] : roster.members()) {
        if (member.state != MemberState::present || member.is_guest) continue;
        HostNeed& need = hosts[member.hello.host];
        need.bytes += still_to_come(plan.worker);
        ++need.workers;
        if (!need.coordinator && member.hello.memory > 0)  // the least that its processes reported
            need.available = need.available == 0 ? member.hello.memory : std::min(need.available, member.hello.memory);
    }
    for (const auto& [name, need] : hosts)
        if (need.available > 0 && need.bytes > need.available)
            throw InputError(
                Location{scene, 0, 0},
                fmt::format("{} of memory are expected to be needed on {}, by {}, but {} are available",
                            gigabytes(need.bytes), name, who(need), gigabytes(need.available)),
                "render a smaller image (--set image.width=...), start fewer workers a host with more threads each, or "
                "go on regardless with --set farm.memory_check=false; treefarm plan lists it by use");
}

}  // namespace treefarm
