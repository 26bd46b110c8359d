// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "common/base/bytes.h"
#include "common/decide/next_event/next_event_sums.h"
#include "common/evidence/blocks.h"
#include "common/guiding/statistics/record_units.h"
#include "common/math/elementary.h"

namespace treefarm {

/// Bins of the mixture histogram of a region (mixture.h) and of a view (view_mixture.h).
inline constexpr int kMixtureBins = 16;
/// First bin of records of next event: `bin - kLightBin` is the emitter's cluster; such records are not for the
/// mixture.
inline constexpr std::uint8_t kLightBin = 64;

/// Record of a path vertex for a distribution: radiance `value` arriving from the direction `code`.
struct Record {
    std::uint32_t distribution;
    std::uint32_t code;      ///< Z-order code of the direction
    std::uint32_t rounding;  ///< uniform bits of the keyed generator, for stochastic rounding
    float value;             ///< L / p (or another target of guiding), >= 0 and finite
    float reflected = 0.0f;  ///< f |cos| L / p, >= 0 and finite; the mixture learns from it
    std::uint8_t bin = 0;    ///< of the mixture histogram, or kLightBin plus a cluster
    bool visit = false;      ///< counts as a visit of its cell, if cells learn means
};

/// Exponent of the unit of emitters' second moments, for records in units of 2^e: a sample like the mean record is 2^16
/// units, and sums hold from 2^-8 to 2^11 times the mean.
inline constexpr int light_sum_exponent(int quantum_exponent) {
    return 2 * quantum_exponent + kMeanRecordBits;
}

/// Record of a next-event sample of `cluster`, chosen with probability `chosen`, with the contribution `reflected`.
Record light_record(std::uint32_t region, int quantum_exponent, std::uint8_t cluster, float chosen, float reflected);

/// Counts of limits that were reached. They are sent with the update and reported.
struct UpdateCaps {
    std::uint64_t capped_records = 0;     ///< contributions above 2^40 quanta
    std::uint64_t saturated_cells = 0;    ///< sums that reached 2^64 - 1
    std::uint64_t outside_positions = 0;  ///< vertices outside the tree's cube

    void add(const UpdateCaps& other);
    bool operator==(const UpdateCaps&) const = default;
};

/// Shape of a CellSums: numbers of cells, distributions and regions, and kinds of sums.
struct SumsShape {
    std::uint32_t regions = 0;
    std::uint32_t views = 0;
    std::uint32_t cells = 0;
    bool with_mixture = false;     ///< mixture histograms: kMixtureBins more sums per distribution
    bool with_lights = false;      ///< sums of emitters: kLightClusters more sums per region
    bool with_visits = false;      ///< visits of cells: one more sum per cell
    bool with_next_event = false;  ///< sums of direct light: kNextEventSums more per region

    SumsShape() = default;
    SumsShape(std::uint32_t region_count, std::uint32_t cell_count, bool mixture = false, std::uint32_t view_count = 0,
              bool lights = false, bool visits = false, bool next_event = false)
        : regions(region_count),
          views(view_count),
          cells(cell_count),
          with_mixture(mixture),
          with_lights(lights),
          with_visits(visits),
          with_next_event(next_event) {}
    bool operator==(const SumsShape&) const = default;
    std::uint32_t distributions() const { return regions + views; }
    /// Index of a distribution's first mixture bin. For the distribution after the last it is the number of bins.
    std::size_t mixture_begin(std::uint32_t distribution) const {
        return with_mixture ? std::size_t{distribution} * kMixtureBins : 0;
    }
};

/// Blocks of a CellSums. A kind of sums that the shape lacks has no rows.
std::vector<BlockShape> cell_blocks(const SumsShape& shape);

/// Sums over the cells and distributions of one model, as blocks: what a guide with cells learns from.
class CellSums {
  public:
    CellSums() = default;
    CellSums(std::uint32_t pass, const SumsShape& shape) : CellSums(pass, shape, Blocks(cell_blocks(shape), pass)) {}
    /// Sums in blocks of this shape.
    CellSums(std::uint32_t pass, const SumsShape& shape, Blocks blocks);
    CellSums(std::uint32_t pass, std::uint32_t regions, std::uint32_t cells, bool with_mixture = false)
        : CellSums(pass, SumsShape(regions, cells, with_mixture)) {}

    const Blocks& blocks() const { return blocks_; }
    Blocks take_blocks() { return std::move(blocks_); }

    std::uint32_t pass() const { return pass_; }
    const LargeTable<std::uint64_t>& cells() const { return blocks_.sums(kCells).values(); }
    /// Recorded vertices per distribution, including those without radiance.
    const LargeTable<std::uint64_t>& counts() const { return blocks_.sums(kCounts).values(); }
    /// Mixture histogram of a distribution; empty if no mixture is learned.
    std::span<const std::uint64_t> mixture(std::uint32_t distribution) const {
        return row(kMixture, shape_.with_mixture, distribution);
    }
    /// Second moments of next event in a region, per cluster of emitters; empty if not learned.
    std::span<const std::uint64_t> lights(std::uint32_t region) const {
        return row(kLights, shape_.with_lights, region);
    }
    /// Sums of direct light of a region; empty if no decision needs them.
    std::span<const std::uint64_t> next_event(std::uint32_t region) const {
        return row(kNextEvent, shape_.with_next_event, region);
    }
    /// Visits per cell; empty if not needed.
    const LargeTable<std::uint64_t>& visits() const { return blocks_.sums(kVisits).values(); }
    const SumsShape& shape() const { return shape_; }
    UpdateCaps caps() const { return caps_of(blocks_); }
    /// Limits that were reached, of the sums' blocks.
    static UpdateCaps caps_of(const Blocks& blocks);

    void add_count(std::uint32_t distribution, std::uint64_t count) { blocks_.sums(kCounts).add(distribution, count); }
    /// Adds to a cell. False if the sum exceeds 2^64 - 1, where it stays.
    bool add_quanta(std::uint32_t cell, std::uint64_t quanta) { return blocks_.sums(kCells).add(cell, quanta); }
    void prefetch_cell(std::uint32_t cell) const { blocks_.sums(kCells).prefetch(cell); }
    void prefetch_mixture(std::uint32_t distribution) const {
        blocks_.sums(kMixture).prefetch(shape_.mixture_begin(distribution));
    }
    void add_visit(std::uint32_t cell) { blocks_.sums(kVisits).add(cell, 1); }
    void add_light(std::uint32_t region, int cluster, std::uint64_t quanta) {
        blocks_.sums(kLights).add(std::size_t{region} * kLightClusters + static_cast<std::size_t>(cluster), quanta);
    }
    void add_next_event(std::uint32_t region, const NextEventSums& sums) {
        for (std::size_t i = 0; i < kNextEventSums; ++i)
            blocks_.sums(kNextEvent).add(std::size_t{region} * kNextEventSums + i, sums[i]);
    }
    void add_mixture(std::uint32_t distribution, std::uint8_t bin, std::uint64_t quanta) {
        blocks_.sums(kMixture).add(shape_.mixture_begin(distribution) + bin, quanta);
    }
    void add_caps(const UpdateCaps& caps);
    void add(const CellSums& other);
    void clear() { blocks_.clear(); }

    /// The form of evidence of a pass with these blocks alone.
    Bytes encode() const;
    /// Adds what encode() wrote; throws FormatError, before anything is added, if it does not fit. Returns the number
    /// of touched cells.
    std::uint64_t merge_encoded(std::span<const std::uint8_t> update);

    bool operator==(const CellSums&) const = default;

  private:
    /// Blocks in the order of cell_blocks(). Cells are the first: reports count those that updates touch.
    enum Number : std::size_t { kCells, kCounts, kMixture, kLights, kVisits, kNextEvent, kCaps };

    std::span<const std::uint64_t> row(Number block, bool exists, std::uint32_t number) const {
        return exists ? blocks_.sums(block).row(number) : std::span<const std::uint64_t>();
    }

    std::uint32_t pass_ = 0;
    SumsShape shape_;
    Blocks blocks_{cell_blocks(SumsShape())};
};

/// Cap of one contribution, in quanta: 2^24 capped ones fit in a cell.
inline constexpr double kMostQuanta = 0x1p40;

/// Value value * per_value rounded stochastically to an integer, so that the expectation is exact; at most kMostQuanta.
/// `per_value`: a power of two, so that scaling in double and splitting off the integer part are exact.
inline double whole_quanta(float value, double per_value, std::uint32_t random) {
    const double quanta = static_cast<double>(value) * per_value;
    const double whole = std::floor(quanta);
    // Signed conversion, for which vector instructions exist.
    const double threshold = static_cast<double>(static_cast<std::int32_t>(random ^ 0x80000000u)) * 0x1p-32 + 0.5;
    return quanta < kMostQuanta ? whole + (threshold < quanta - whole ? 1.0 : 0.0) : kMostQuanta;
}

/// Value value / 2^exponent rounded by whole_quanta(). Above 2^40 quanta it is capped and `capped` is set.
inline std::uint64_t quantise(float value, int exponent, std::uint32_t random, bool& capped) {
    const double quanta = whole_quanta(value, exact_power_of_two(-exponent), random);
    capped = capped || quanta >= kMostQuanta;  // a float beyond 2^24 is an integer: rounding does not bring it there
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(quanta));
}

}  // namespace treefarm
