// SPDX-License-Identifier: Apache-2.0
#include "coordinator/farm/partial_pass.h"

namespace treefarm {

namespace {

/// Upper ends of the unit ranges that a pass may have, by kind.
std::array<std::uint64_t, kUnitKinds> range_ends(const PassPlan& plan, std::uint64_t pixels) {
    std::array<std::uint64_t, kUnitKinds> ends{};
    ends[static_cast<std::size_t>(UnitKind::light_paths)] = pixels * plan.units.light_paths;
    ends[static_cast<std::size_t>(UnitKind::chains)] = plan.units.chains;
    return ends;
}

}  // namespace

bool has_possible_units(const PartialPass& partial, std::uint64_t pixels) {
    const auto ends = range_ends(partial.plan, pixels);
    if (!partial.done.fits(pixels, partial.plan.chunks, ends)) return false;
    DoneWork taken = partial.done;
    const auto is_there = [&](const WorkUnit& unit) {
        const auto kind = static_cast<std::size_t>(unit.kind);
        if (unit.pass != partial.plan.index || kind >= kUnitKinds) return false;
        if (unit.kind == UnitKind::tile) return taken.holds(unit);
        return unit.count > 0 && unit.count <= ends[kind] && unit.first <= ends[kind] - unit.count;
    };
    for (const PoisonUnit& poison : partial.poison_units) {
        if (poison.deaths == 0 || poison.deaths >= Ledger::kMostDeaths || !is_there(poison.unit)) return false;
        if (taken.left_of(poison.unit) != std::vector<WorkUnit>{poison.unit}) return false;
        taken.add(poison.unit);
    }
    return true;
}

}  // namespace treefarm
