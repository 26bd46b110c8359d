// SPDX-License-Identifier: Apache-2.0
#include "coordinator/ledger.h"

#include <algorithm>

namespace treefarm {

namespace {

/// A piece of fewer paths, 2 ms or so, costs more in messages than it saves in waiting.
constexpr std::uint32_t kLeastPaths = 2048;
/// Pixels that a piece has at least, however many samples they have.
constexpr std::uint32_t kLeastPixels = 16;

}  // namespace

Ledger::Ledger(const PassPlan& plan, int width, int height, int tile_size) : unit_spp_(plan.unit_spp()) {
    const std::vector<WorkUnit> units = cut_pass(plan, width, height, tile_size);
    waiting_.assign(units.begin(), units.end());
    for (const WorkUnit& unit : units)
        total_ += weight(unit);
}

std::uint64_t Ledger::least_weight(UnitKind kind) const {
    switch (kind) {
        case UnitKind::tile:
            return std::max(kLeastPixels, kLeastPaths / unit_spp_);
        case UnitKind::light_paths:
            return kLeastPaths;
        case UnitKind::chains:
            return 1;
    }
    return 1;
}

void Ledger::halve_front() {
    const std::vector<WorkUnit> pieces = halve(waiting_.front());
    if (weight(waiting_.front()) < pieces.size() * least_weight(waiting_.front().kind)) return;
    waiting_.pop_front();
    waiting_.insert(waiting_.begin(), pieces.begin(), pieces.end());
}

std::vector<WorkUnit> Ledger::issue(int worker, std::size_t count, std::size_t shrink_below) {
    std::vector<WorkUnit> units;
    while (units.size() < count && !waiting_.empty()) {
        if (waiting_.size() < shrink_below) halve_front();
        units.push_back(waiting_.front());
        holder_[waiting_.front()] = worker;
        waiting_.pop_front();
    }
    return units;
}

bool Ledger::holds(int worker, std::span<const WorkUnit> units) const {
    std::vector<WorkUnit> sorted(units.begin(), units.end());
    std::sort(sorted.begin(), sorted.end());
    if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) return false;
    for (const WorkUnit& unit : units) {
        const auto held = holder_.find(unit);
        if (held == holder_.end() || held->second != worker) return false;
    }
    return true;
}

bool Ledger::accept(int worker, std::span<const WorkUnit> units) {
    if (!holds(worker, units)) return false;
    for (const WorkUnit& unit : units) {
        holder_.erase(unit);
        done_ += weight(unit);
    }
    return true;
}

std::size_t Ledger::reclaim(int worker) {
    std::size_t count = 0;
    for (auto held = holder_.end(); held != holder_.begin();) {  // backwards, so that the first unit comes out first
        const auto here = std::prev(held);
        if (here->second != worker) {
            held = here;
            continue;
        }
        waiting_.push_front(here->first);
        held = holder_.erase(here);
        ++count;
    }
    return count;
}

std::size_t Ledger::outstanding(int worker) const {
    return static_cast<std::size_t>(
        std::count_if(holder_.begin(), holder_.end(), [&](const auto& held) { return held.second == worker; }));
}

}  // namespace treefarm
