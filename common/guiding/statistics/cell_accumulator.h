// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <mutex>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "common/base/prefetch.h"
#include "common/guiding/statistics/box_filter.h"
#include "common/guiding/statistics/cell_sums.h"
#include "common/guiding/statistics/record_log.h"
#include "common/guiding/statistics/settings.h"

namespace treefarm {

/// Records in the order of their distributions.
struct RecordOrder {
    std::vector<std::uint32_t> records;  ///< indices in the log
    std::vector<std::uint32_t> ends;     ///< per distribution: index in `records` at which the next one begins
};

/// Order by counting sort: a unit has many records for few distributions.
RecordOrder order_by_distribution(std::span<const Record> records, std::size_t distributions);

/// Whether a sampler's cells learn means of their records instead of sums.
template <class Sampler>
constexpr bool counts_visits() {
    if constexpr (requires { Sampler::kCountsVisits; }) return Sampler::kCountsVisits;
    return false;
}

/// Adds the records of finished work to a worker's sums per cell. Each thread fills a log while it traces and commits
/// it once per unit, ordered by distribution: so a stripe of distributions is locked once for many records, and cells
/// are found in the cache.
///
/// A `Sampler` with cells is a RegionSampler that provides cell() (the cell of a direction's code in a distribution),
/// cell_side(), cell_count(), and prefetch_pdf() and prefetch_pdf_cell(), which fetch the data that cell() reads. A
/// sampler whose cells learn means has a constant kCountsVisits that is true: its records count only for the cells of
/// their directions, without a filter.
template <class Sampler>
class CellAccumulator {
  public:
    using Log = RecordLog;
    using Sums = CellSums;
    using Shape = SumsShape;

    /// `with_mixture`: records also feed the histograms of mixture.h.
    CellAccumulator(std::uint32_t pass, const Sampler& guide, DirectionalFilter filter = DirectionalFilter::nearest,
                    bool with_mixture = false)
        : guide_(guide), filter_(filter), with_mixture_(with_mixture), sums_(pass, shape()) {}

    /// Adds a unit's records, its vertex counts per distribution, and its sums of direct light per region if these are
    /// needed. Thread-safe.
    void commit(std::span<const Record> records, std::span<const std::uint32_t> counts, const UpdateCaps& caps,
                std::span<const NextEventSums> next_event = {});

    void commit(const Log& log) { commit(log.records, log.counts, log.caps, log.next_event); }

    /// Moves the sums out and starts again from zero. Must not run during a commit.
    CellSums take();
    /// Takes the blocks of cleared sums back for reuse by the next take(). Must not run during take().
    void give_back(Blocks cleared);

  private:
    static constexpr std::size_t kStripes = 64;
    static constexpr bool kCountsVisits = counts_visits<Sampler>();

    /// Cell of each record of a block.
    using BlockCells = std::array<std::uint32_t, BoxBlock::kRecords>;

    /// Quanta for the cells of several codes.
    struct Overlaps {
        static constexpr std::uint32_t kMost = BoxBlock::kRecords * (BoxBlock::kParts - 1);
        std::uint32_t count = 0;
        std::array<std::uint32_t, kMost> distribution, code, cell;
        std::array<std::uint64_t, kMost> quanta;
    };

    template <class DistributionOf, class CodeOf>
    void find_cells(std::uint32_t count, DistributionOf distribution, CodeOf code, std::span<std::uint32_t> cells);
    /// Copies the records at the first `count` of `indices`, and prefetches the records that follow.
    static void gather(std::span<const Record> records, std::span<const std::uint32_t> indices, std::size_t count,
                       std::array<Record, BoxBlock::kRecords>& block) {
        const std::size_t last = indices.size() - 1;
        for (std::size_t i = 0; i < count; ++i) {
            prefetch_line(&records[indices[std::min(i + count, last)]]);
            block[i] = records[indices[i]];
        }
    }
    static std::uint64_t counted(float value, int exponent, std::uint32_t random, UpdateCaps& met) {
        bool capped = false;
        const std::uint64_t quanta = quantise(value, exponent, random, capped);
        met.capped_records += capped;
        return quanta;
    }
    void add_block(std::span<const Record> records, UpdateCaps& met);
    void add_boxes(std::span<const Record> records, const BlockCells& cells, UpdateCaps& met);
    void add_reflected(const Record& record, UpdateCaps& met);
    int exponent(const Record& record) const { return guide_.quantum_exponent(record.distribution); }

    SumsShape shape() const {
        const std::uint32_t regions = guide_.region_count();
        return {regions,
                guide_.cell_count(),
                with_mixture_,
                guide_.distribution_count() - regions,
                guide_.learns_lights(),
                kCountsVisits,
                guide_.decides_next_event()};
    }

    const Sampler& guide_;
    const DirectionalFilter filter_;
    const bool with_mixture_;
    CellSums sums_;
    std::optional<CellSums> spare_;  ///< cleared sums for reuse
    std::mutex caps_lock_;
    std::array<std::mutex, kStripes> stripe_locks_;
};

/// Computes the cells of `count` codes and prefetches their sums. Each step prefetches, for all codes, the data of the
/// next step.
template <class Sampler>
template <class DistributionOf, class CodeOf>
void CellAccumulator<Sampler>::find_cells(std::uint32_t count, DistributionOf distribution, CodeOf code,
                                          std::span<std::uint32_t> cells) {
    for (std::uint32_t i = 0; i < count; ++i)
        guide_.prefetch_pdf(distribution(i), code(i));
    for (std::uint32_t i = 0; i < count; ++i)
        guide_.prefetch_pdf_cell(distribution(i), code(i));
    for (std::uint32_t i = 0; i < count; ++i) {
        cells[i] = guide_.cell(distribution(i), code(i));
        sums_.prefetch_cell(cells[i]);
    }
}

template <class Sampler>
void CellAccumulator<Sampler>::add_block(std::span<const Record> records, UpdateCaps& met) {
    BlockCells cells;
    find_cells(
        static_cast<std::uint32_t>(records.size()), [&](std::uint32_t i) { return records[i].distribution; },
        [&](std::uint32_t i) { return records[i].code; }, cells);
    if (with_mixture_)
        for (const Record& record : records)
            sums_.prefetch_mixture(record.distribution);
    if constexpr (kCountsVisits)
        for (std::uint32_t i = 0; i < records.size(); ++i)
            if (records[i].visit) sums_.add_visit(cells[i]);
    if (!kCountsVisits && filter_ == DirectionalFilter::box)
        add_boxes(records, cells, met);
    else
        for (std::uint32_t i = 0; i < records.size(); ++i)
            sums_.add_quanta(cells[i], counted(records[i].value, exponent(records[i]), records[i].rounding, met));
    for (const Record& record : records)
        add_reflected(record, met);
}

template <class Sampler>
void CellAccumulator<Sampler>::add_boxes(std::span<const Record> records, const BlockCells& cells, UpdateCaps& met) {
    BoxBlock boxes;
    for (std::uint32_t i = 0; i < records.size(); ++i)
        boxes.set(i, records[i], guide_.cell_side(records[i].distribution, cells[i]), exponent(records[i]));
    met.capped_records += boxes.cut(static_cast<std::uint32_t>(records.size()));
    Overlaps others;
    for (std::uint32_t i = 0; i < records.size(); ++i) {
        sums_.add_quanta(cells[i], boxes.quanta(0, i));
        for (std::uint32_t part = 1; part < BoxBlock::kParts; ++part) {
            others.distribution[others.count] = records[i].distribution;
            others.code[others.count] = boxes.part_code(part, i);
            others.quanta[others.count] = boxes.quanta(part, i);
            others.count += others.quanta[others.count] != 0;
        }
    }
    find_cells(
        others.count, [&](std::uint32_t i) { return others.distribution[i]; },
        [&](std::uint32_t i) { return others.code[i]; }, others.cell);
    for (std::uint32_t i = 0; i < others.count; ++i)
        sums_.add_quanta(others.cell[i], others.quanta[i]);
}

/// Adds the contribution of a record to the statistics of mixture or next event.
template <class Sampler>
void CellAccumulator<Sampler>::add_reflected(const Record& record, UpdateCaps& met) {
    if (record.bin >= kLightBin) {
        const std::uint64_t units = counted(record.reflected, 0, record.rounding, met);
        sums_.add_light(record.distribution, record.bin - kLightBin, units);
    } else if (with_mixture_ && record.reflected > 0.0f) {
        const std::uint64_t quanta = counted(record.reflected, exponent(record), scrambled(record.rounding, 0), met);
        if (quanta != 0) sums_.add_mixture(record.distribution, record.bin, quanta);
    }
}

template <class Sampler>
void CellAccumulator<Sampler>::commit(std::span<const Record> records, std::span<const std::uint32_t> counts,
                                      const UpdateCaps& caps, std::span<const NextEventSums> next_event) {
    const std::size_t distributions = counts.size();
    const RecordOrder order = order_by_distribution(records, distributions);

    // Consecutive distributions share a stripe: ordered records visit each stripe once.
    const std::size_t stripe_size = (distributions + kStripes - 1) / kStripes;
    UpdateCaps met = caps;
    std::array<Record, BoxBlock::kRecords> block;
    std::span<const std::uint32_t> rest(order.records);
    for (std::size_t begin = 0, stripe = 0; begin < distributions; begin += stripe_size, ++stripe) {
        const std::size_t stop = std::min(begin + stripe_size, distributions);
        const std::lock_guard lock(stripe_locks_[stripe]);
        for (std::size_t d = begin; d < stop; ++d)
            if (counts[d] != 0) sums_.add_count(static_cast<std::uint32_t>(d), counts[d]);
        for (std::size_t d = begin; d < std::min(stop, next_event.size()); ++d)
            if (next_event[d] != NextEventSums{}) sums_.add_next_event(static_cast<std::uint32_t>(d), next_event[d]);
        for (const std::size_t after = order.records.size() - order.ends[stop - 1]; rest.size() > after;) {
            const std::size_t count = std::min<std::size_t>(BoxBlock::kRecords, rest.size() - after);
            gather(records, rest, count, block);
            add_block({block.data(), count}, met);
            rest = rest.subspan(count);
        }
    }
    const std::lock_guard lock(caps_lock_);
    sums_.add_caps(met);
}

template <class Sampler>
CellSums CellAccumulator<Sampler>::take() {
    CellSums next = spare_ ? std::move(*spare_) : CellSums(sums_.pass(), shape());
    spare_.reset();
    return std::exchange(sums_, std::move(next));
}

template <class Sampler>
void CellAccumulator<Sampler>::give_back(Blocks cleared) {
    spare_.emplace(sums_.pass(), shape(), std::move(cleared));
}

}  // namespace treefarm
