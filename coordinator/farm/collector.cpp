// SPDX-License-Identifier: Apache-2.0
#include "coordinator/farm/collector.h"

#include <algorithm>
#include <cmath>

#include "common/base/timer.h"
#include "common/film/radiance_limit.h"
#include "common/math/saturating.h"

namespace treefarm {

namespace {

bool is_duration(double seconds) {
    constexpr double kLongest = 1e10;  // three hundred years
    return seconds >= 0 && seconds < kLongest;
}

}  // namespace

Collector::Collector(const PassPlan& plan, const AnyModel& model, int width, int height, bool signed_pixels,
                     const AovLayout& aovs)
    : plan_(plan),
      width_(width),
      height_(height),
      signed_pixels_(signed_pixels),
      done_(width, height, plan.chunks),
      film_(plan.layers.estimates ? width : 0, plan.layers.estimates ? height : 0, plan.chunks),
      aovs_(aovs, width, height, plan.chunks),
      splats_(plan.layers.splats),
      evidence_(no_evidence(plan, model)) {}

std::uint32_t Collector::unit_samples(const WorkUnit& unit) const {
    const std::uint64_t per_unit = std::uint64_t{kBlockSamples} * plan_.blocks_per_unit;
    const std::uint64_t begin = per_unit * unit.chunk;
    return begin < plan_.spp ? static_cast<std::uint32_t>(std::min<std::uint64_t>(per_unit, plan_.spp - begin)) : 0;
}

void Collector::check_pixels(const UnitResult& result) const {
    const bool estimated = plan_.layers.estimates && result.unit.kind == UnitKind::tile;
    if (result.pixels.empty() == estimated)
        throw FormatError("a work unit without its pixels, or with some of its own");
    if (!estimated) return;
    const std::uint64_t begin = std::uint64_t{kBlockSamples} * plan_.blocks_per_unit * result.unit.chunk;
    const HalfCounts counts = half_counts(plan_.first_sample + begin, unit_samples(result.unit));
    const PixelEstimate& first = result.pixels.front();  // the codec gives all pixels of a unit the same counts
    if (first.half[0].n != counts[0] || first.half[1].n != counts[1])
        throw FormatError("a work unit with the wrong number of samples per pixel");
    for (const PixelEstimate& pixel : result.pixels)
        for (const Moments& half : pixel.half)
            if (!are_moments_of_radiance(half, signed_pixels_))
                throw FormatError("a pixel that is negative, not finite or too large");
}

void Collector::check_stats(const Result& result) const {
    const TraceStats& s = result.stats;
    std::uint64_t paths = 0;
    for (const UnitResult& unit : result.units)
        paths += weight(unit.unit) * (unit.unit.kind == UnitKind::tile ? unit_samples(unit.unit) : 1);
    if (s.paths != paths || s.nonzero_paths > paths || s.invalid_samples > paths)
        throw FormatError("counts of paths that do not fit the work units");
    for (const std::uint64_t count : {s.rays, s.shadow_rays, s.vertices, s.records})
        if (count > kMostClaim) throw FormatError("a count that is too large");
    if (s.split_path_rays > s.rays) throw FormatError("more rays of split paths than rays");
    if (!is_duration(s.trace_seconds) || !is_duration(s.splat_seconds) || !is_duration(s.busy_seconds) ||
        !std::all_of(s.phase_seconds.begin(), s.phase_seconds.end(), is_duration))
        throw FormatError("an impossible number of seconds");
    if (s.first_invalid.size() > TraceStats::kMaxReported)
        throw FormatError("more invalid samples than the limit of reports");
    for (const InvalidSample& sample : s.first_invalid)
        if (sample.pass != plan_.index || sample.x >= width_ || sample.y >= height_ || sample.sample >= plan_.spp)
            throw FormatError("an invalid sample outside the film");
    check_tails(s.tails);
}

void Collector::check_tails(const TailSamples& tails) const {
    if (tails.worst.size() > TailSamples::kMost) throw FormatError("more worst samples than the limit of reports");
    for (const TailSample& sample : tails.worst)
        if (!(sample.noise > 0) || !std::isfinite(sample.noise) || sample.pass != plan_.index || sample.x >= width_ ||
            sample.y >= height_ || sample.sample >= plan_.spp)
            throw FormatError("an impossible worst sample");
    if (!std::is_sorted(tails.worst.begin(), tails.worst.end(), comes_before))
        throw FormatError("worst samples that are not sorted by noise");
}

void Collector::check_splats(const Result& result) const {
    if (result.splats.empty()) return;
    if (plan_.layers.splats.pixels == 0) throw FormatError("splats of a pass that has none");
    splats_.check(result.splats);
}

Verdict Collector::take(int worker, Result result, Ledger& ledger) {
    std::vector<WorkUnit> units;
    for (const UnitResult& unit : result.units) {
        check_pixels(unit);
        if (unit.unit.kind == UnitKind::tile)
            aovs_.check(unit.unit, unit.aovs, unit_samples(unit.unit), signed_pixels_);
        units.push_back(unit.unit);
    }
    check_stats(result);
    check_splats(result);
    if (result.pass != plan_.index) return Verdict::protocol_error;
    if (const Verdict verdict = ledger.judge(worker, units); verdict != Verdict::accepted) {
        if (verdict == Verdict::late) ledger.drop(worker, units);
        return verdict;
    }
    // merge_encoded checks everything before it adds anything: a result counts as a whole or not at all.
    Timer timer;
    const std::vector<std::uint64_t> entries = evidence_.merge_encoded(result.evidence);
    if (plan_.record) touched_cells_ += entries[kGuideEvidence];
    merge_seconds_ += timer.seconds();
    timer.restart();
    ledger.accept(worker, units);
    update_bytes_ += result.evidence.size();
    splat_bytes_ += result.splats.size();
    WorkerContribution& contribution = contributions_[worker];
    for (const UnitResult& unit : result.units) {
        if (!unit.pixels.empty()) {
            film_.add(unit.unit, unit.pixels);
            aovs_.add(unit.unit, unit.aovs);
        }
        done_.add(unit.unit);
        contribution.work += weight(unit.unit);
    }
    if (!result.splats.empty()) splats_.merge_encoded(result.splats);
    contribution.stats.add(result.stats);
    film_seconds_ += timer.seconds();
    return Verdict::accepted;
}

void Collector::fill(PartialPass& partial) const {
    partial.plan = plan_;
    partial.done = done_;
    if (plan_.layers.estimates) partial.film = film_.encode(done_);
    partial.aovs = aovs_.encode(done_);
    if (plan_.layers.splats.pixels > 0) partial.splats = splats_.encode();
    partial.evidence = evidence_.encode();
    partial.stats = totals();
    partial.update_bytes = update_bytes_;
    partial.splat_bytes = splat_bytes_;
    partial.touched_cells = touched_cells_;
}

void Collector::restore(const PartialPass& partial) {
    const auto pixels = static_cast<std::uint64_t>(width_) * static_cast<std::uint64_t>(height_);
    if (!(partial.plan == plan_) || !has_possible_units(partial, pixels)) throw FormatError("units of another pass");
    if (partial.film.empty() != (partial.done.estimate_count() == 0 || !plan_.layers.estimates) ||
        partial.splats.empty() != (plan_.layers.splats.pixels == 0))
        throw FormatError("layers that differ from the pass's");
    if (plan_.layers.estimates) film_.restore(partial.done, partial.film);
    aovs_.restore(partial.done, partial.aovs);
    if (!partial.splats.empty()) splats_.merge_encoded(partial.splats);
    evidence_.merge_encoded(partial.evidence, EvidencePart::total);
    done_ = partial.done;
    earlier_ = partial.stats;
    update_bytes_ = partial.update_bytes;
    splat_bytes_ = partial.splat_bytes;
    touched_cells_ = partial.touched_cells;
}

std::span<const PixelEstimate> Collector::pixels_so_far() const {
    if (plan_.layers.splats.pixels > 0) return {};
    return film_.pixels();
}

std::vector<PixelEstimate> Collector::take_pixels() {
    return develop(film_.take_pixels(), splats_, plan_.splatting_paths(), plan_.splatting_chains());
}

TraceStats Collector::totals() const {
    TraceStats totals = earlier_;
    for (const auto& [worker, contribution] : contributions_)
        totals.add(contribution.stats);
    return totals;
}

}  // namespace treefarm
