// SPDX-License-Identifier: Apache-2.0
#include "common/guiding/statistics/cell_sums.h"

#include <algorithm>

#include "common/math/saturating.h"

namespace treefarm {
namespace {

/// Cap of the contribution of one next-event sample; a larger one counts as this, which makes its emitter slightly less
/// likely.
constexpr double kMostLightUnits = 0x1p38;

/// Reads a sparse list: pairs (distance from the previous index, value), both varints. Calls visit(index, value).
template <class Visit>
void read_sparse(ByteReader& in, std::size_t limit, const char* what, Visit visit) {
    const std::size_t count = in.get_count(2);
    std::uint64_t next = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint64_t skip = in.get_varint();
        if (skip >= limit - next)
            throw FormatError(std::string("a tree update names a ") + what + " beyond the tree's " +
                              std::to_string(limit));
        next += skip;
        const std::uint64_t value = in.get_varint();
        if (value == 0) throw FormatError(std::string("a tree update holds an empty ") + what);
        visit(next, value);
        ++next;
        if (next == limit && i + 1 < count)
            throw FormatError(std::string("a tree update names a ") + what + " beyond the tree's " +
                              std::to_string(limit));
    }
}

/// Refuses a count that no worker reaches, before it is added to others.
void check_count(std::uint64_t, std::uint64_t count) {
    if (count > kMostClaim) throw FormatError("a tree update with a count that is too large");
}

void write_sparse(ByteWriter& out, std::span<const std::uint64_t> values) {
    std::uint64_t count = 0;
    for (const std::uint64_t v : values)
        count += v != 0;
    out.put_varint(count);
    std::size_t next = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (values[i] == 0) continue;
        out.put_varint(i - next);
        out.put_varint(values[i]);
        next = i + 1;
    }
}

}  // namespace

void UpdateCaps::add(const UpdateCaps& other) {
    capped_records += other.capped_records;
    saturated_cells += other.saturated_cells;
    outside_positions += other.outside_positions;
}

CellSums::CellSums(std::uint32_t pass, const SumsShape& shape)
    : pass_(pass),
      shape_(shape),
      cells_(shape.cells),
      visits_(shape.with_visits ? shape.cells : 0),
      counts_(shape.regions + shape.views),
      mixture_(shape.mixture_begin(shape.regions + shape.views)),
      lights_(shape.light_sums()),
      next_event_(shape.next_event_sums()) {}

bool CellSums::add_light(std::uint32_t region, int cluster, std::uint64_t quanta) {
    return add_saturating(lights_[std::size_t{region} * kLightClusters + static_cast<std::size_t>(cluster)], quanta);
}

void CellSums::add(const CellSums& other) {
    if (other.pass_ != pass_ || other.shape_ != shape_) throw RunError("sums of different trees cannot be added");
    for (std::size_t c = 0; c < cells_.size(); ++c)
        if (!add_quanta(static_cast<std::uint32_t>(c), other.cells_[c])) ++caps_.saturated_cells;
    for (std::size_t r = 0; r < counts_.size(); ++r)
        counts_[r] += other.counts_[r];
    for (std::size_t c = 0; c < visits_.size(); ++c)
        if (!add_saturating(visits_[c], other.visits_[c])) ++caps_.saturated_cells;
    for (std::size_t m = 0; m < mixture_.size(); ++m)
        if (!add_saturating(mixture_[m], other.mixture_[m])) ++caps_.saturated_cells;
    for (std::size_t l = 0; l < lights_.size(); ++l)
        if (!add_saturating(lights_[l], other.lights_[l])) ++caps_.saturated_cells;
    for (std::size_t n = 0; n < next_event_.size(); ++n)
        add_saturating(next_event_[n], other.next_event_[n]);
    caps_.add(other.caps_);
}

void CellSums::clear() {
    std::fill(cells_.begin(), cells_.end(), 0);
    std::fill(counts_.begin(), counts_.end(), 0);
    std::fill(visits_.begin(), visits_.end(), 0);
    std::fill(mixture_.begin(), mixture_.end(), 0);
    std::fill(lights_.begin(), lights_.end(), 0);
    std::fill(next_event_.begin(), next_event_.end(), 0);
    caps_ = {};
}

Bytes CellSums::encode() const {
    ByteWriter out;
    out.put_varint(pass_);
    out.put_varint(cells_.size());
    out.put_varint(counts_.size());
    out.put_varint(mixture_.size());
    out.put_varint(lights_.size());
    out.put_varint(caps_.capped_records);
    out.put_varint(caps_.saturated_cells);
    out.put_varint(caps_.outside_positions);
    write_sparse(out, counts_);
    write_sparse(out, cells_);
    write_sparse(out, mixture_);
    write_sparse(out, lights_);
    if (shape_.with_visits) write_sparse(out, visits_);
    if (shape_.with_next_event) write_sparse(out, next_event_);
    return out.take();
}

std::uint64_t CellSums::merge_encoded(std::span<const std::uint8_t> update) {
    // Two readings: the first only checks, so that a malformed message changes nothing.
    const auto read = [&](auto&& on_count, auto&& on_cell, auto&& on_mixture, auto&& on_light, auto&& on_visits,
                          auto&& on_next_event) {
        ByteReader in(update);
        const std::uint64_t pass = in.get_varint(), cells = in.get_varint(), distributions = in.get_varint();
        const std::uint64_t bins = in.get_varint(), lights = in.get_varint();
        if (bins != mixture_.size() || lights != lights_.size() || pass != pass_ || cells != cells_.size() ||
            distributions != counts_.size())
            throw FormatError("a tree update of pass " + std::to_string(pass) + " with " + std::to_string(cells) +
                              " cells does not fit the tree of pass " + std::to_string(pass_) + " with " +
                              std::to_string(cells_.size()));
        UpdateCaps caps;
        caps.capped_records = in.get_varint();
        caps.saturated_cells = in.get_varint();
        caps.outside_positions = in.get_varint();
        read_sparse(in, counts_.size(), "distribution", on_count);
        read_sparse(in, cells_.size(), "cell", on_cell);
        read_sparse(in, mixture_.size(), "mixture bin", on_mixture);
        read_sparse(in, lights_.size(), "cluster of emitters", on_light);
        if (shape_.with_visits) read_sparse(in, visits_.size(), "visited cell", on_visits);
        if (shape_.with_next_event) read_sparse(in, next_event_.size(), "sum of direct light", on_next_event);
        in.expect_end();
        return caps;
    };
    const auto ignore = [](std::uint64_t, std::uint64_t) {};
    const UpdateCaps claimed = read(check_count, ignore, ignore, ignore, check_count, ignore);
    for (const std::uint64_t count : {claimed.capped_records, claimed.saturated_cells, claimed.outside_positions})
        check_count(0, count);
    std::uint64_t touched = 0;
    const UpdateCaps caps =
        read([&](std::uint64_t distribution, std::uint64_t count) { counts_[distribution] += count; },
             [&](std::uint64_t cell, std::uint64_t sum) {
                 if (!add_quanta(static_cast<std::uint32_t>(cell), sum)) ++caps_.saturated_cells;
                 ++touched;
             },
             [&](std::uint64_t bin, std::uint64_t sum) {
                 if (!add_saturating(mixture_[bin], sum)) ++caps_.saturated_cells;
             },
             [&](std::uint64_t light, std::uint64_t sum) {
                 if (!add_saturating(lights_[light], sum)) ++caps_.saturated_cells;
             },
             [&](std::uint64_t cell, std::uint64_t visits) {
                 if (!add_saturating(visits_[cell], visits)) ++caps_.saturated_cells;
             },
             [&](std::uint64_t index, std::uint64_t sum) { add_saturating(next_event_[index], sum); });
    caps_.add(caps);
    return touched;
}

Record light_record(std::uint32_t region, int quantum_exponent, std::uint8_t cluster, float chosen, float reflected) {
    const auto x = static_cast<double>(reflected);
    const double units =
        x * x * static_cast<double>(chosen) * exact_power_of_two(-light_sum_exponent(quantum_exponent));
    // Halves round up: with 2^16 units per record no randomness is needed.
    return {region,
            0,
            std::uint32_t{1} << 31,
            0.0f,
            static_cast<float>(std::min(units, kMostLightUnits)),
            static_cast<std::uint8_t>(kLightBin + cluster)};
}

}  // namespace treefarm
