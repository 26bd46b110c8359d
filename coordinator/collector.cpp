#include "coordinator/collector.h"

#include <algorithm>

#include "common/base/timer.h"
#include "common/plan/learning.h"

namespace treefarm {

Collector::Collector(const PassPlan& plan, const SdTree& tree, int width, int height)
    : plan_(plan),
      film_(width, height, plan.chunks),
      sums_(plan.record ? TreeSums(plan.index, sums_shape(plan, tree)) : TreeSums()) {}

void Collector::check_samples(const UnitResult& result) const {
    const std::uint64_t per_unit = std::uint64_t{kBlockSamples} * plan_.blocks_per_unit;
    const std::uint64_t first = per_unit * result.unit.chunk;
    const std::uint64_t expected = first < plan_.spp ? std::min<std::uint64_t>(per_unit, plan_.spp - first) : 0;
    const PixelEstimate& pixel = result.pixels.front();  // the codec gives all pixels of a unit the same counts
    if (std::uint64_t{pixel.half[0].n} + pixel.half[1].n != expected)
        throw FormatError("a work unit with the wrong number of samples per pixel");
}

bool Collector::take(int worker, Result result, Ledger& ledger) {
    std::vector<WorkUnit> units;
    for (const UnitResult& unit : result.units) {
        check_samples(unit);
        units.push_back(unit.unit);
    }
    if (result.pass != plan_.index || !ledger.holds(worker, units)) return false;
    // merge_encoded checks everything before it adds anything: a result counts whole or not at all.
    Timer timer;
    if (plan_.record) touched_cells_ += sums_.merge_encoded(result.update);
    merge_seconds_ += timer.seconds();
    timer.restart();
    ledger.accept(worker, units);
    update_bytes_ += result.update.size();
    WorkerShare& share = shares_[worker];
    for (const UnitResult& unit : result.units) {
        film_.add(unit.unit, unit.pixels);
        share.pixels += unit.unit.pixel_count();
    }
    share.stats.add(result.stats);
    film_seconds_ += timer.seconds();
    return true;
}

TraceStats Collector::totals() const {
    TraceStats totals;
    for (const auto& [worker, share] : shares_)
        totals.add(share.stats);
    return totals;
}

}  // namespace treefarm
