// SPDX-License-Identifier: Apache-2.0
#include "coordinator/collector.h"

#include <algorithm>
#include <cmath>

#include "common/base/timer.h"
#include "common/plan/learning.h"

namespace treefarm {

namespace {

bool is_amount(double value) {
    return value >= 0 && std::isfinite(value);
}

bool is_duration(double seconds) {
    constexpr double kLongest = 1e10;  // three hundred years
    return seconds >= 0 && seconds < kLongest;
}

}  // namespace

Collector::Collector(const PassPlan& plan, const SdTree& tree, int width, int height, bool signed_pixels)
    : plan_(plan),
      signed_pixels_(signed_pixels),
      film_(width, height, plan.chunks),
      sums_(plan.record ? TreeSums(plan.index, sums_shape(plan, tree)) : TreeSums()) {}

void Collector::check_pixels(const UnitResult& result) const {
    const std::uint64_t per_unit = std::uint64_t{kBlockSamples} * plan_.blocks_per_unit;
    const std::uint64_t begin = per_unit * result.unit.chunk;
    const std::uint64_t count = begin < plan_.spp ? std::min<std::uint64_t>(per_unit, plan_.spp - begin) : 0;
    const std::uint64_t even = (count + 1 - (plan_.first_sample + begin) % 2) / 2;
    const PixelEstimate& first = result.pixels.front();  // the codec gives all pixels of a unit the same counts
    if (first.half[0].n != even || std::uint64_t{first.half[0].n} + first.half[1].n != count)
        throw FormatError("a work unit with the wrong number of samples per pixel");
    const auto possible = [](const Rgb64& v) { return is_amount(v.x) && is_amount(v.y) && is_amount(v.z); };
    for (const PixelEstimate& pixel : result.pixels)
        for (const Moments& half : pixel.half)
            if (!(signed_pixels_
                      ? (std::isfinite(half.mean.x) && std::isfinite(half.mean.y) && std::isfinite(half.mean.z))
                      : possible(half.mean)) ||
                !possible(half.m2))
                throw FormatError("a pixel that is negative or no finite number");
}

void Collector::check_stats(const Result& result) const {
    const TraceStats& s = result.stats;
    std::uint64_t paths = 0;
    for (const UnitResult& unit : result.units)
        paths += (std::uint64_t{unit.pixels.front().half[0].n} + unit.pixels.front().half[1].n) * unit.pixels.size();
    if (s.paths != paths || s.nonzero_paths > paths || s.invalid_samples > paths ||
        s.probe_paths > (plan_.probe ? paths : 0))
        throw FormatError("counts of paths that do not fit the work units");
    if (!is_duration(s.trace_seconds) || !is_duration(s.splat_seconds) ||
        !std::all_of(s.phase_seconds.begin(), s.phase_seconds.end(), is_duration))
        throw FormatError("seconds that no clock shows");
    if (s.first_invalid.size() > TraceStats::kMaxReported) throw FormatError("more invalid samples than are reported");
    for (const InvalidSample& sample : s.first_invalid)
        if (sample.pass != plan_.index || sample.x >= film_.width() || sample.y >= film_.height() ||
            sample.sample >= plan_.spp)
            throw FormatError("an invalid sample outside the film");
}

bool Collector::take(int worker, Result result, Ledger& ledger) {
    std::vector<WorkUnit> units;
    for (const UnitResult& unit : result.units) {
        check_pixels(unit);
        units.push_back(unit.unit);
    }
    check_stats(result);
    if (result.pass != plan_.index || !ledger.holds(worker, units)) return false;
    // merge_encoded checks everything before it adds anything: a result counts whole or not at all.
    Timer timer;
    if (plan_.record) touched_cells_ += sums_.merge_encoded(result.update);
    merge_seconds_ += timer.seconds();
    timer.restart();
    ledger.accept(worker, units);
    update_bytes_ += result.update.size();
    WorkerContribution& contribution = contributions_[worker];
    for (const UnitResult& unit : result.units) {
        film_.add(unit.unit, unit.pixels);
        contribution.pixels += unit.unit.pixel_count();
    }
    contribution.stats.add(result.stats);
    film_seconds_ += timer.seconds();
    return true;
}

TraceStats Collector::totals() const {
    TraceStats totals;
    for (const auto& [worker, contribution] : contributions_)
        totals.add(contribution.stats);
    return totals;
}

}  // namespace treefarm
