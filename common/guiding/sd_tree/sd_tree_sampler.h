// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "common/base/large_table.h"
#include "common/base/prefetch.h"
#include "common/base/random.h"
#include "common/guiding/regions/region_sampler.h"
#include "common/guiding/sd_tree/sd_tree.h"
#include "common/math/direction_map.h"

namespace treefarm {

/// The tree in the form that workers sample from: per region a flat cumulative table with look-up entries
/// (bench/guide_bench.cpp shows why). Immutable; one per process, shared by its threads.
class SdTreeSampler : public RegionSampler {
  public:
    explicit SdTreeSampler(const SdTree& tree);

    /// A sampled point of the direction square (direction_map.h), with the density of the cell that it was drawn from.
    struct SquareSample {
        Vec2 at;             ///< point in [0, 1)^2
        std::uint32_t code;  ///< its Z-order code, inside the sampled cell
        float pdf;           ///< per steradian of the direction, > 0
    };

    /// A sampled direction, with the density of the cell that it was drawn from.
    struct Sample {
        Vec3 direction;      ///< unit length
        std::uint32_t code;  ///< its Z-order code on the direction square, inside the sampled cell
        float pdf;           ///< per steradian, > 0
    };

    std::uint32_t view_count() const { return distribution_count() - region_count(); }
    std::uint32_t cell_count() const {
        return static_cast<std::uint32_t>(cells_.size()) - kFewCells - distribution_count();
    }
    /// Probability of sampling the view with this distribution.
    float view_fraction(std::uint32_t distribution) const { return view_fraction_[distribution - region_count()]; }

    /// Distribution (region_count() or more) of the view for light leaving `region` in the direction with this code;
    /// kNoView if the region has no T2.
    static constexpr std::uint32_t kNoView = 0xffffffffu;
    std::uint32_t view(std::uint32_t region, std::uint32_t outgoing_code) const;

    /// Prefetches the first data that view() reads.
    void prefetch_views(std::uint32_t region) const {
        if (!views_.empty()) prefetch_line(&views_[region]);
    }

    /// Prefetches the first data that sample() with this `pick` reads.
    void prefetch(std::uint32_t distribution, std::uint32_t pick) const {
        prefetch_line(&bsdf_fraction_[distribution]);
        prefetch_line(by_mass(distribution, pick >> (32 - kMassBits)));
    }

    /// Prefetches the second data that sample() reads, which depend on the first.
    void prefetch_cell(std::uint32_t distribution, std::uint32_t pick) const {
        prefetch_ends(range(by_mass(distribution, pick >> (32 - kMassBits))));
    }

    /// Draws a direction; `pick`, `u0` and `u1` are uniform 32-bit numbers.
    Sample sample(std::uint32_t distribution, std::uint32_t pick, std::uint32_t u0, std::uint32_t u1) const {
        const SquareSample drawn = sample_square(distribution, pick, u0, u1);
        return {square_to_direction(drawn.at), drawn.code, drawn.pdf};
    }
    Sample sample(std::uint32_t distribution, const Draw& random) const {
        return sample(distribution, random[1], random[2], random[3]);
    }
    /// Draws a point as sample() does, without its direction, which is faster to compute for many points at once.
    SquareSample sample_square(std::uint32_t distribution, std::uint32_t pick, std::uint32_t u0,
                               std::uint32_t u1) const;

    /// Prefetches the first data that pdf() and cell() with this code read.
    void prefetch_pdf(std::uint32_t distribution, std::uint32_t code) const {
        prefetch_line(by_code(distribution, code));
    }

    /// Prefetches the second data that pdf() and cell() read, which depend on the first.
    void prefetch_pdf_cell(std::uint32_t distribution, std::uint32_t code) const {
        prefetch_ends(range(by_code(distribution, code)));
    }

    /// Density per steradian of the direction with this code; 0 if the tree has no records there.
    float pdf(std::uint32_t distribution, std::uint32_t code) const;

    /// Mean radiance that the region has learned for the direction with this code; negative if nothing was learned.
    float radiance(std::uint32_t region, std::uint32_t code) const {
        return flux(region) > 0.0f ? flux(region) * pdf(region, code) : -1.0f;
    }

    /// Index, over the whole tree, of a direction's cell, to which records are added.
    std::uint32_t cell(std::uint32_t distribution, std::uint32_t code) const {
        return static_cast<std::uint32_t>(find(distribution, code) - cells_.data()) - distribution;
    }
    /// Side of a cell, in steps of the direction square: 2^(kDirectionBits - depth).
    std::uint32_t cell_side(std::uint32_t distribution, std::uint32_t cell) const {
        const Cell* const c = &cells_[cell + distribution];
        return 1u << (std::countr_zero(c[1].code_begin - c[0].code_begin) / 2);
    }

    std::size_t bytes() const;

  private:
    struct Cell {
        std::uint32_t code_begin;  ///< first Z-order code of the cell, modulo 2^32
        std::uint32_t mass_begin;  ///< cumulative probability before the cell, times 2^kMassBits
    };
    /// Cells that a look-up has to search.
    struct Range {
        const Cell* first;
        std::uint32_t count;
    };
    /// Look-up table of a distribution. Entry k of 2^bits: first cell that may hold keys from k / 2^bits of the key
    /// range on.
    template <int bits>
    using LookupTable = std::array<std::uint32_t, (1u << bits) + 1>;
    static constexpr int kRegionBits = 6;
    static constexpr int kViewBits = 4;  ///< views are many and small

    static float density(const Cell* cell);
    template <int bits>
    void fill_lookups(LookupTable<bits>& by_mass, LookupTable<bits>& by_code, std::size_t first) const;
    /// Table entry for this key. The cell is between the cells of this entry and of the next.
    const std::uint32_t* by_mass(std::uint32_t distribution, std::uint32_t mass) const {
        return distribution < region_count()
                   ? &region_mass_[distribution][mass >> (kMassBits - kRegionBits)]
                   : &view_mass_[distribution - region_count()][mass >> (kMassBits - kViewBits)];
    }
    const std::uint32_t* by_code(std::uint32_t distribution, std::uint32_t code) const {
        return distribution < region_count()
                   ? &region_code_[distribution][code >> (2 * kDirectionBits - kRegionBits)]
                   : &view_code_[distribution - region_count()][code >> (2 * kDirectionBits - kViewBits)];
    }
    Range range(const std::uint32_t* entry) const { return {&cells_[entry[0]], entry[1] - entry[0] + 1}; }
    /// Cells of a range are adjacent: most are in one cache line, or in two.
    static void prefetch_ends(const Range& among) {
        prefetch_line(among.first);
        prefetch_line(among.first + among.count);
    }
    const Cell* find(std::uint32_t distribution, std::uint32_t code) const {
        return last_before(range(by_code(distribution, code)), &Cell::code_begin, code);
    }
    /// The last cell whose `begin` is at or before `key`. Most ranges have at most eight cells: three steps without
    /// branches, since their number would be unpredictable.
    static const Cell* last_before(const Range& range, std::uint32_t Cell::*begin, std::uint32_t key) {
        const Cell* first = range.first;
        std::uint32_t count = range.count;
        for (; count > kFewCells; count -= count / 2)
            first += first[count / 2].*begin <= key ? count / 2 : 0;
        std::uint32_t at = 0;
        for (std::uint32_t step = kFewCells / 2; step > 0; step /= 2) {
            const std::uint32_t next = at + step;
            at += step & (0u - (static_cast<std::uint32_t>(next < count) &
                                static_cast<std::uint32_t>(first[next].*begin <= key)));
        }
        return first + at;
    }
    static constexpr std::uint32_t kFewCells = 8;  ///< also the number of cells that may be read beyond a range
    void add_distribution(const SdTree& tree, std::uint32_t distribution);
    void add_views(const SdTree& tree);

    LargeTable<Cell> cells_;  ///< each distribution's, then one at which the next would begin: cell c of distribution d
                              ///< is c + d; kFewCells more at the end
    LargeTable<LookupTable<kRegionBits>> region_mass_, region_code_;
    LargeTable<LookupTable<kViewBits>> view_mass_, view_code_;
    struct Views {
        std::uint32_t first = 0, count = 0;  ///< views of a region
    };
    std::vector<Views> views_;               ///< per region; empty if no region has views
    std::vector<std::uint32_t> view_begin_;  ///< per view: first Z-order code of its outgoing directions
    std::vector<float> view_fraction_;
};

}  // namespace treefarm
