#include "common/guiding/splat.h"

#include <algorithm>

namespace treefarm {
namespace {

/// Counting sort: a unit has many records for few distributions.
std::vector<Record> sort_by_distribution(std::span<const Record> records, std::size_t distributions) {
    std::vector<std::uint32_t> next(distributions + 1);
    for (const Record& record : records)
        ++next[record.distribution + 1];
    for (std::size_t d = 0; d < distributions; ++d)
        next[d + 1] += next[d];
    std::vector<Record> sorted(records.size());
    for (const Record& record : records)
        sorted[next[record.distribution]++] = record;
    return sorted;
}

/// More random bits from a record's own (the finaliser of MurmurHash3).
std::uint32_t scrambled(std::uint32_t bits, std::uint32_t salt) {
    bits ^= salt * 0x9e3779b9u;
    bits = (bits ^ (bits >> 16)) * 0x85ebca6bu;
    bits = (bits ^ (bits >> 13)) * 0xc2b2ae35u;
    return bits ^ (bits >> 16);
}

constexpr std::int32_t kSteps = 1 << kDirectionBits;

/// Code of a point of the direction square, given in steps and possibly up to half the square beyond an edge: there the
/// octahedral map goes on at the mirrored place of the same edge.
std::uint32_t folded_code(std::int32_t x, std::int32_t y) {
    const auto fold = [](std::int32_t& across, std::int32_t& along) {
        if (across >= 0 && across < kSteps) return;
        across = across < 0 ? -1 - across : 2 * kSteps - 1 - across;
        along = kSteps - 1 - along;
    };
    fold(x, y);
    fold(y, x);
    return spread_bits(static_cast<std::uint32_t>(x)) | (spread_bits(static_cast<std::uint32_t>(y)) << 1);
}

}  // namespace

Accumulator::Accumulator(std::uint32_t pass, const Guide& guide, DirectionalFilter filter, bool with_mixture)
    : guide_(guide), filter_(filter), with_mixture_(with_mixture), sums_(pass, shape()) {}

void Accumulator::add_quanta(const Record& record, std::uint32_t code, float value, std::uint32_t random,
                             UpdateCaps& met) {
    bool capped = false;
    const std::uint64_t quanta = quantise(value, guide_.quantum_exponent(record.distribution), random, capped);
    met.capped_records += capped;
    if (quanta != 0 && !sums_.add_quanta(guide_.cell(record.distribution, code), quanta)) ++met.saturated_cells;
}

/// A square of the cell's size around the record overlaps two by two squares of the grid of that size. Each gets its
/// share; where it is cut finer, at a point drawn from the overlap, so that the expectation is that of the box.
void Accumulator::add_box(const Record& record, UpdateCaps& met) {
    const auto side =
        static_cast<std::int32_t>(guide_.cell_side(record.distribution, guide_.cell(record.distribution, record.code)));
    if (side == 1) return add_quanta(record, record.code, record.value, record.rounding, met);
    const std::int32_t left = static_cast<std::int32_t>(compact_bits(record.code)) - side / 2;
    const std::int32_t top = static_cast<std::int32_t>(compact_bits(record.code >> 1)) - side / 2;
    const float per_step = record.value / (static_cast<float>(side) * static_cast<float>(side));
    // Where the square crosses a line of the grid: the parts before and after.
    const std::int32_t before_x = side - (left & (side - 1)), before_y = side - (top & (side - 1));
    for (std::uint32_t part = 0; part < 4; ++part) {
        const bool right = part & 1, lower = part & 2;
        const std::int32_t width = right ? side - before_x : before_x, height = lower ? side - before_y : before_y;
        if (width == 0 || height == 0) continue;
        const std::uint32_t place = scrambled(record.rounding, 2 * part + 1);
        const std::int32_t x = left + (right ? before_x : 0) +
                               static_cast<std::int32_t>((place & 0xffffu) * static_cast<std::uint32_t>(width) >> 16);
        const std::int32_t y = top + (lower ? before_y : 0) +
                               static_cast<std::int32_t>((place >> 16) * static_cast<std::uint32_t>(height) >> 16);
        add_quanta(record, folded_code(x, y), per_step * (static_cast<float>(width) * static_cast<float>(height)),
                   scrambled(record.rounding, 2 * part + 2), met);
    }
}

void Accumulator::add_record(const Record& record, UpdateCaps& met) {
    bool capped = false;
    if (record.bin >= kLightBin) {
        const std::uint64_t units = quantise(record.reflected, 0, record.rounding, capped);
        if (units != 0 && !sums_.add_light(record.distribution, record.bin - kLightBin, units)) ++met.saturated_cells;
        return;
    }
    if (filter_ == DirectionalFilter::box)
        add_box(record, met);
    else
        add_quanta(record, record.code, record.value, record.rounding, met);
    if (!with_mixture_ || !(record.reflected > 0.0f)) return;
    const std::uint64_t quanta =
        quantise(record.reflected, guide_.quantum_exponent(record.distribution), scrambled(record.rounding, 0), capped);
    met.capped_records += capped;
    if (quanta != 0 && !sums_.add_mixture(record.distribution, record.bin, quanta)) ++met.saturated_cells;
}

void Accumulator::commit(std::span<const Record> records, std::span<const std::uint32_t> counts,
                         const UpdateCaps& caps) {
    const std::vector<Record> sorted = sort_by_distribution(records, counts.size());

    // Consecutive distributions share a stripe: sorted records walk through the stripes once.
    const std::size_t distributions = counts.size();
    const std::size_t stripe_size = (distributions + kStripes - 1) / kStripes;
    UpdateCaps met = caps;
    const Record* record = sorted.data();
    const Record* const end = record + sorted.size();
    for (std::size_t begin = 0, stripe = 0; begin < distributions; begin += stripe_size, ++stripe) {
        const std::size_t stop = std::min(begin + stripe_size, distributions);
        const std::lock_guard lock(stripe_locks_[stripe]);
        for (std::size_t d = begin; d < stop; ++d)
            if (counts[d] != 0) sums_.add_count(static_cast<std::uint32_t>(d), counts[d]);
        for (; record != end && record->distribution < stop; ++record)
            add_record(*record, met);
    }
    const std::lock_guard lock(caps_lock_);
    sums_.add_caps(met);
}

TreeSums Accumulator::take() {
    TreeSums taken(sums_.pass(), shape());
    std::swap(taken, sums_);
    return taken;
}

}  // namespace treefarm
