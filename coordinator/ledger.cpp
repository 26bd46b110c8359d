// SPDX-License-Identifier: Apache-2.0
#include "coordinator/ledger.h"

#include <algorithm>

namespace treefarm {

namespace {

/// A piece of fewer camera paths, 2 ms or so, costs more in messages than it saves in waiting.
constexpr std::uint32_t kLeastPaths = 2048;
/// Pixels that a piece has at least, however many samples they have.
constexpr std::uint32_t kLeastPixels = 16;

}  // namespace

Ledger::Ledger(const PassPlan& plan, int width, int height, int tile_size)
    : least_pixels_(std::max(kLeastPixels, kLeastPaths / plan.unit_spp())),
      total_(static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height) * plan.chunks) {
    const std::vector<WorkUnit> units = cut_pass(plan.index, plan.chunks, width, height, tile_size);
    waiting_.assign(units.begin(), units.end());
}

void Ledger::quarter_front() {
    const WorkUnit unit = waiting_.front();
    if (unit.pixel_count() < 4 * least_pixels_ || unit.x1 - unit.x0 < 2 || unit.y1 - unit.y0 < 2) return;
    waiting_.pop_front();
    const auto xm = static_cast<std::uint16_t>((unit.x0 + unit.x1) / 2);
    const auto ym = static_cast<std::uint16_t>((unit.y0 + unit.y1) / 2);
    waiting_.push_front({unit.pass, xm, ym, unit.x1, unit.y1, unit.chunk});
    waiting_.push_front({unit.pass, unit.x0, ym, xm, unit.y1, unit.chunk});
    waiting_.push_front({unit.pass, xm, unit.y0, unit.x1, ym, unit.chunk});
    waiting_.push_front({unit.pass, unit.x0, unit.y0, xm, ym, unit.chunk});
}

std::vector<WorkUnit> Ledger::issue(int worker, std::size_t count, std::size_t shrink_below) {
    std::vector<WorkUnit> units;
    while (units.size() < count && !waiting_.empty()) {
        if (waiting_.size() < shrink_below) quarter_front();
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
        done_ += unit.pixel_count();
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
