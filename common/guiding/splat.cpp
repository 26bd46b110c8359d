// SPDX-License-Identifier: Apache-2.0
#include "common/guiding/splat.h"

#include <algorithm>
#include <utility>

#include "common/base/prefetch.h"

namespace treefarm {
namespace {

/// Records in the order of their distributions.
struct Order {
    std::vector<std::uint32_t> records;  ///< their indices in the log
    std::vector<std::uint32_t> ends;     ///< per distribution: where among `records` the next one's begin
};

/// Counting sort: a unit has many records for few distributions.
Order order_by_distribution(std::span<const Record> records, std::size_t distributions) {
    std::vector<std::uint32_t> next(distributions + 1);
    for (const Record& record : records)
        ++next[record.distribution + 1];
    for (std::size_t d = 0; d < distributions; ++d)
        next[d + 1] += next[d];
    std::vector<std::uint32_t> order(records.size());
    for (std::uint32_t i = 0; i < records.size(); ++i)
        order[next[records[i].distribution]++] = i;
    return {std::move(order), std::move(next)};
}

/// Copies the records at the first `count` of `places`, and has as many that follow fetched meanwhile.
void gather(std::span<const Record> records, std::span<const std::uint32_t> indices, std::size_t count,
            std::array<Record, BoxBlock::kRecords>& block) {
    const std::size_t last = indices.size() - 1;
    for (std::size_t i = 0; i < count; ++i) {
        prefetch_line(&records[indices[std::min(i + count, last)]]);
        block[i] = records[indices[i]];
    }
}

std::uint64_t counted(float value, int exponent, std::uint32_t random, UpdateCaps& met) {
    bool capped = false;
    const std::uint64_t quanta = quantise(value, exponent, random, capped);
    met.capped_records += capped;
    return quanta;
}

}  // namespace

Accumulator::Accumulator(std::uint32_t pass, const Guide& guide, DirectionalFilter filter, bool with_mixture)
    : guide_(guide), filter_(filter), with_mixture_(with_mixture), sums_(pass, shape()) {}

/// The cells of `count` codes, and their sums fetched. Each step fetches for all what the next one reads.
template <class DistributionOf, class CodeOf>
void Accumulator::find_cells(std::uint32_t count, DistributionOf distribution, CodeOf code,
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

void Accumulator::add_block(std::span<const Record> records, UpdateCaps& met) {
    BlockCells cells;
    find_cells(
        static_cast<std::uint32_t>(records.size()), [&](std::uint32_t i) { return records[i].distribution; },
        [&](std::uint32_t i) { return records[i].code; }, cells);
    if (with_mixture_)
        for (const Record& record : records)
            sums_.prefetch_mixture(record.distribution);
    if (filter_ == DirectionalFilter::box)
        add_boxes(records, cells, met);
    else
        for (std::uint32_t i = 0; i < records.size(); ++i)
            add_to_cell(cells[i], counted(records[i].value, exponent(records[i]), records[i].rounding, met), met);
    for (const Record& record : records)
        add_reflected(record, met);
}

void Accumulator::add_boxes(std::span<const Record> records, const BlockCells& cells, UpdateCaps& met) {
    BoxBlock boxes;
    for (std::uint32_t i = 0; i < records.size(); ++i)
        boxes.set(i, records[i], guide_.cell_side(records[i].distribution, cells[i]), exponent(records[i]));
    met.capped_records += boxes.cut(static_cast<std::uint32_t>(records.size()));
    Overlaps others;
    for (std::uint32_t i = 0; i < records.size(); ++i) {
        add_to_cell(cells[i], boxes.quanta(0, i), met);
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
        add_to_cell(others.cell[i], others.quanta[i], met);
}

/// Adds what the mixture, or next event, learns of a record.
void Accumulator::add_reflected(const Record& record, UpdateCaps& met) {
    if (record.bin >= kLightBin) {
        const std::uint64_t units = counted(record.reflected, 0, record.rounding, met);
        if (units != 0 && !sums_.add_light(record.distribution, record.bin - kLightBin, units)) ++met.saturated_cells;
    } else if (with_mixture_ && record.reflected > 0.0f) {
        const std::uint64_t quanta = counted(record.reflected, exponent(record), scrambled(record.rounding, 0), met);
        if (quanta != 0 && !sums_.add_mixture(record.distribution, record.bin, quanta)) ++met.saturated_cells;
    }
}

void Accumulator::add_to_cell(std::uint32_t cell, std::uint64_t quanta, UpdateCaps& met) {
    if (!sums_.add_quanta(cell, quanta)) ++met.saturated_cells;
}

void Accumulator::commit(std::span<const Record> records, std::span<const std::uint32_t> counts,
                         const UpdateCaps& caps) {
    const std::size_t distributions = counts.size();
    const Order order = order_by_distribution(records, distributions);

    // Consecutive distributions share a stripe: ordered records walk through the stripes once.
    const std::size_t stripe_size = (distributions + kStripes - 1) / kStripes;
    UpdateCaps met = caps;
    std::array<Record, BoxBlock::kRecords> block;
    std::span<const std::uint32_t> rest(order.records);
    for (std::size_t begin = 0, stripe = 0; begin < distributions; begin += stripe_size, ++stripe) {
        const std::size_t stop = std::min(begin + stripe_size, distributions);
        const std::lock_guard lock(stripe_locks_[stripe]);
        for (std::size_t d = begin; d < stop; ++d)
            if (counts[d] != 0) sums_.add_count(static_cast<std::uint32_t>(d), counts[d]);
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

TreeSums Accumulator::take() {
    TreeSums next = spare_ ? std::move(*spare_) : TreeSums(sums_.pass(), shape());
    spare_.reset();
    return std::exchange(sums_, std::move(next));
}

void Accumulator::give_back(TreeSums cleared) {
    spare_ = std::move(cleared);
}

}  // namespace treefarm
