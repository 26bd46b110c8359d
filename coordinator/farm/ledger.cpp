// SPDX-License-Identifier: Apache-2.0
#include "coordinator/farm/ledger.h"

#include <algorithm>
#include <limits>

namespace treefarm {

namespace {

/// Least paths of a piece, about 2 ms: a smaller one costs more in messages than it saves in waiting.
constexpr std::uint32_t kLeastPaths = 2048;
/// Least pixels of a piece, whatever their samples.
constexpr std::uint32_t kLeastPixels = 16;
/// Numbers from this downwards: workers lost before a resume, which have no peer number now.
constexpr int kOfEarlierLives = -2;

}  // namespace

Ledger::Ledger(const PassPlan& plan, int width, int height, int tile_size, const DoneWork& done,
               std::span<const PoisonUnit> poison_units)
    : unit_spp_(plan.unit_spp()), done_(done.weight()) {
    const std::vector<WorkUnit> units = cut_pass(plan, width, height, tile_size);
    for (const WorkUnit& unit : units)
        total_ += weight(unit);
    if (done.empty() && poison_units.empty()) {
        waiting_.assign(units.begin(), units.end());
    } else {
        DoneWork taken = done.pixel_count() > 0 ? done : DoneWork(width, height, plan.chunks);
        for (const PoisonUnit& each : poison_units) {
            taken.add(each.unit);
            suspects_.push_back(each.unit);
            for (std::uint32_t k = 0; k < each.deaths; ++k)
                deaths_[each.unit].insert(kOfEarlierLives - static_cast<int>(k));
        }
        for (const WorkUnit& unit : units) {
            const std::vector<WorkUnit> left = taken.left_of(unit);
            waiting_.insert(waiting_.end(), left.begin(), left.end());
        }
    }
    for (const WorkUnit& unit : waiting_)
        waiting_paths_ += paths(unit);
}

std::uint64_t Ledger::paths(const WorkUnit& unit) const {
    return weight(unit) * (unit.kind == UnitKind::tile ? unit_spp_ : 1);
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

/// Cuts the next unit if it has more than `most_paths` paths and its pieces are not too small.
bool Ledger::cut_front(std::uint64_t most_paths) {
    const WorkUnit front = waiting_.front();
    if (paths(front) <= most_paths) return false;
    const std::vector<WorkUnit> pieces = halve(front);
    if (pieces.size() < 2 || weight(front) < pieces.size() * least_weight(front.kind)) return false;
    waiting_.pop_front();
    waiting_.insert(waiting_.begin(), pieces.begin(), pieces.end());
    return true;
}

void Ledger::hold(const WorkUnit& unit, int worker) {
    holders_[unit] = {{worker}, issued_++};
    burden(worker, unit);
}

void Ledger::burden(int worker, const WorkUnit& unit) {
    Load& load = loads_[worker];
    ++load.units;
    load.paths += paths(unit);
}

void Ledger::lighten(int worker, const WorkUnit& unit) {
    Load& load = loads_[worker];
    --load.units;
    load.paths -= paths(unit);
}

bool Ledger::has_suspect(int worker) const {
    return std::any_of(deaths_.begin(), deaths_.end(), [&](const auto& death) {
        const auto held = holders_.find(death.first);
        return held != holders_.end() && held->second.has(worker);
    });
}

std::vector<WorkUnit> Ledger::issue(int worker, Portion portion, bool overdue) {
    std::vector<WorkUnit> units;
    if (portion.units == 0 || (!overdue && !deaths_.empty() && has_suspect(worker))) return units;
    if (!suspects_.empty() && (overdue || outstanding(worker) == 0)) {
        units.push_back(suspects_.front());
        suspects_.pop_front();
    }
    const bool alone = !units.empty();
    for (std::uint64_t left = portion.paths; !alone && units.size() < portion.units && !waiting_.empty();) {
        while (cut_front(portion.piece)) {
        }
        const WorkUnit unit = waiting_.front();
        if (!units.empty() && paths(unit) > left) break;
        left -= std::min(left, paths(unit));
        units.push_back(unit);
        waiting_.pop_front();
    }
    for (const WorkUnit& unit : units) {
        if (!alone) waiting_paths_ -= paths(unit);
        hold(unit, worker);
    }
    return units;
}

std::vector<WorkUnit> Ledger::issue_copies(int worker, std::size_t count,
                                           const std::function<double(int, const WorkUnit&)>& gain, bool overdue) {
    std::vector<WorkUnit> units;
    if (!waiting_.empty() || (!overdue && outstanding(worker) != 0)) return units;
    struct Candidate {
        double gain;
        std::uint64_t issued;
        WorkUnit unit;
    };
    std::vector<Candidate> candidates;
    for (const auto& [unit, holders] : holders_) {
        if (holders.has(worker)) continue;
        double saved = std::numeric_limits<double>::infinity();
        for (const int other : holders.workers)
            saved = std::min(saved, gain(other, unit));
        if (saved > 0) candidates.push_back({saved, holders.issued, unit});
    }
    std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
        return a.gain != b.gain ? a.gain > b.gain : a.issued > b.issued;
    });
    for (const Candidate& candidate : candidates) {
        if (units.size() == count) break;
        units.push_back(candidate.unit);
        holders_[candidate.unit].workers.push_back(worker);
        burden(worker, candidate.unit);
    }
    copies_ += units.size();
    return units;
}

Verdict Ledger::judge(int worker, std::span<const WorkUnit> units) const {
    std::vector<WorkUnit> sorted(units.begin(), units.end());
    std::sort(sorted.begin(), sorted.end());
    if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) return Verdict::protocol_error;
    bool late = false;
    for (const WorkUnit& unit : units) {
        const auto held = holders_.find(unit);
        if (held != holders_.end() && held->second.has(worker)) continue;
        if (!superseded_.contains({worker, unit})) return Verdict::protocol_error;
        late = true;
    }
    return late ? Verdict::late : Verdict::accepted;
}

Verdict Ledger::accept(int worker, std::span<const WorkUnit> units) {
    const Verdict verdict = judge(worker, units);
    if (verdict != Verdict::accepted) return verdict;
    for (const WorkUnit& unit : units) {
        const auto held = holders_.find(unit);
        for (const int holder : held->second.workers) {
            if (holder != worker) superseded_.insert({holder, unit});
            lighten(holder, unit);
        }
        holders_.erase(held);
        deaths_.erase(unit);
        done_ += weight(unit);
    }
    return verdict;
}

void Ledger::put_back(const WorkUnit& unit) {
    if (deaths_.contains(unit)) {
        suspects_.push_front(unit);
        return;
    }
    waiting_.push_front(unit);
    waiting_paths_ += paths(unit);
}

/// Takes a unit from one of its workers. Returns whether no worker has it any more, and it was put back.
bool Ledger::release(std::map<WorkUnit, Holders>::iterator held, int worker) {
    const WorkUnit unit = held->first;
    lighten(worker, unit);
    std::erase(held->second.workers, worker);
    if (!held->second.workers.empty()) return false;
    holders_.erase(held);
    put_back(unit);
    return true;
}

void Ledger::drop(int worker, std::span<const WorkUnit> units) {
    for (const WorkUnit& unit : units) {
        superseded_.erase({worker, unit});
        told_.erase({worker, unit});
        if (const auto held = holders_.find(unit); held != holders_.end()) release(held, worker);
    }
}

std::vector<WorkUnit> Ledger::take_superseded(int worker) {
    std::vector<WorkUnit> units;
    for (auto at = superseded_.lower_bound({worker, WorkUnit{}}); at != superseded_.end() && at->first == worker; ++at)
        if (told_.insert(*at).second) units.push_back(at->second);
    return units;
}

std::size_t Ledger::reclaim(int worker, bool lost) {
    std::vector<WorkUnit> units;
    for (const auto& [unit, holders] : holders_)
        if (holders.has(worker)) units.push_back(unit);
    if (lost)
        for (const WorkUnit& unit : units)
            deaths_[unit].insert(worker);
    for (auto unit = units.rbegin(); unit != units.rend(); ++unit)  // so that the first one is issued first
        release(holders_.find(*unit), worker);
    std::erase_if(superseded_, [&](const auto& entry) { return entry.first == worker; });
    std::erase_if(told_, [&](const auto& entry) { return entry.first == worker; });
    return units.size();
}

void Ledger::forgive(int worker) {
    for (auto& [unit, workers] : deaths_)
        workers.erase(worker);
    std::erase_if(deaths_, [](const auto& death) { return death.second.empty(); });
}

std::pair<WorkUnit, std::size_t> Ledger::worst_poison_unit() const {
    std::pair<WorkUnit, std::size_t> most{{}, 0};
    for (const auto& [unit, workers] : deaths_)
        if (workers.size() > most.second) most = {unit, workers.size()};
    return most;
}

std::vector<PoisonUnit> Ledger::poison_units() const {
    std::vector<PoisonUnit> units;
    for (const auto& [unit, workers] : deaths_)
        units.push_back({unit, static_cast<std::uint32_t>(std::min(workers.size(), kMostDeaths - 1))});
    return units;
}

std::size_t Ledger::outstanding(int worker) const {
    const auto load = loads_.find(worker);
    return load == loads_.end() ? 0 : load->second.units;
}

std::uint64_t Ledger::outstanding_paths(int worker) const {
    const auto load = loads_.find(worker);
    return load == loads_.end() ? 0 : load->second.paths;
}

}  // namespace treefarm
