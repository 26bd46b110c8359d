#include "common/guiding/splat.h"

#include <algorithm>

namespace treefarm {
namespace {

/// Counting sort: a unit has many records for few regions.
std::vector<Record> sort_by_region(std::span<const Record> records, std::size_t regions) {
    std::vector<std::uint32_t> next(regions + 1);
    for (const Record& record : records)
        ++next[record.region + 1];
    for (std::size_t r = 0; r < regions; ++r)
        next[r + 1] += next[r];
    std::vector<Record> sorted(records.size());
    for (const Record& record : records)
        sorted[next[record.region]++] = record;
    return sorted;
}

}  // namespace

Accumulator::Accumulator(std::uint32_t pass, const Guide& guide)
    : guide_(guide), sums_(pass, guide.region_count(), guide.cell_count()) {}

void Accumulator::commit(std::span<const Record> records, std::span<const std::uint32_t> counts,
                         const UpdateCaps& caps) {
    const std::vector<Record> sorted = sort_by_region(records, counts.size());

    // Consecutive regions share a stripe: sorted records walk through the stripes once.
    const std::size_t regions = counts.size();
    const std::size_t stripe_size = (regions + kStripes - 1) / kStripes;
    UpdateCaps met = caps;
    const Record* record = sorted.data();
    const Record* const end = record + sorted.size();
    for (std::size_t begin = 0, stripe = 0; begin < regions; begin += stripe_size, ++stripe) {
        const std::size_t stop = std::min(begin + stripe_size, regions);
        const std::lock_guard lock(stripe_locks_[stripe]);
        for (std::size_t r = begin; r < stop; ++r)
            if (counts[r] != 0) sums_.add_count(static_cast<std::uint32_t>(r), counts[r]);
        for (; record != end && record->region < stop; ++record) {
            bool capped = false;
            const std::uint64_t quanta =
                quantise(record->value, guide_.quantum_exponent(record->region), record->rounding, capped);
            met.capped_records += capped;
            if (quanta != 0 && !sums_.add_quanta(guide_.cell(record->region, record->code), quanta))
                ++met.saturated_cells;
        }
    }
    const std::lock_guard lock(caps_lock_);
    sums_.add_caps(met);
}

TreeSums Accumulator::take() {
    TreeSums taken(sums_.pass(), guide_.region_count(), guide_.cell_count());
    std::swap(taken, sums_);
    return taken;
}

}  // namespace treefarm
