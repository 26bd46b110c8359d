// SPDX-License-Identifier: Apache-2.0
#include "common/guiding/sd_tree/sd_tree_sampler.h"

#include <bit>

namespace treefarm {

SdTreeSampler::SdTreeSampler(const SdTree& tree) : RegionSampler(tree), view_fraction_(tree.view_fraction) {
    cells_.reserve(tree.cell_count() + distribution_count() + kFewCells);
    region_mass_.resize(region_count());
    region_code_.resize(region_count());
    for (std::uint32_t r = 0; r < region_count(); ++r) {
        const std::size_t first = cells_.size();
        add_distribution(tree, r);
        fill_lookups<kRegionBits>(region_mass_[r], region_code_[r], first);
    }
    add_views(tree);
    cells_.resize(cells_.size() + kFewCells);
}

void SdTreeSampler::add_views(const SdTree& tree) {
    view_mass_.resize(tree.view_count());
    view_code_.resize(tree.view_count());
    for (std::uint32_t v = 0; v < tree.view_count(); ++v) {
        const std::size_t first = cells_.size();
        add_distribution(tree, region_count() + v);
        fill_lookups<kViewBits>(view_mass_[v], view_code_[v], first);
    }
    views_.resize(tree.view_set.size());
    for (std::uint32_t r = 0; r < views_.size(); ++r)
        if (const std::uint32_t set = tree.view_set[r]; set != SdTree::kNoViews)
            views_[r] = {tree.view_begin[set], tree.view_begin[set + 1] - tree.view_begin[set]};
    for (std::uint32_t t = 0; t < tree.view_set_count(); ++t) {
        std::uint64_t code = 0;
        for (std::uint32_t v = tree.view_begin[t]; v < tree.view_begin[t + 1]; ++v) {
            view_begin_.push_back(static_cast<std::uint32_t>(code));
            code += std::uint64_t{1} << (2 * (kDirectionBits - tree.view_depth[v]));
        }
    }
}

void SdTreeSampler::add_distribution(const SdTree& tree, std::uint32_t distribution) {
    std::uint64_t code = 0;
    std::uint32_t mass = 0;
    for (std::uint32_t c = tree.cell_begin[distribution]; c < tree.cell_begin[distribution + 1]; ++c) {
        cells_.push_back({static_cast<std::uint32_t>(code), mass});
        code += std::uint64_t{1} << (2 * (kDirectionBits - tree.cell_depth[c]));
        mass += tree.cell_mass[c];
    }
    cells_.push_back({static_cast<std::uint32_t>(code), mass});
}

/// Fills a distribution's look-up tables; a binary search runs between entries k and k + 1.
template <int bits>
void SdTreeSampler::fill_lookups(LookupTable<bits>& by_mass, LookupTable<bits>& by_code, std::size_t first) const {
    constexpr std::uint32_t kSize = 1u << bits;
    const std::size_t end = cells_.size() - 1;
    std::uint32_t next_mass = 0, next_code = 0;
    for (std::size_t i = first; i < end; ++i) {
        const auto index = static_cast<std::uint32_t>(i);
        for (; next_mass < kSize && (next_mass << (kMassBits - bits)) < cells_[i + 1].mass_begin; ++next_mass)
            by_mass[next_mass] = index;
        // The last cell ends at 2^32, which a 32-bit code cannot express.
        for (; next_code < kSize &&
               (i + 1 == end || (next_code << (2 * kDirectionBits - bits)) < cells_[i + 1].code_begin);
             ++next_code)
            by_code[next_code] = index;
    }
    by_mass[kSize] = by_code[kSize] = static_cast<std::uint32_t>(end - 1);
}

float SdTreeSampler::density(const Cell* cell) {
    const std::uint32_t mass = cell[1].mass_begin - cell[0].mass_begin;
    const std::uint32_t area = cell[1].code_begin - cell[0].code_begin;  // a power of two
    constexpr float kScale = kInvFourPi * static_cast<float>(1u << (2 * kDirectionBits - kMassBits));
    return kScale * static_cast<float>(static_cast<std::int32_t>(mass)) * power_of_two(-std::countr_zero(area));
}

std::uint32_t SdTreeSampler::view(std::uint32_t region, std::uint32_t outgoing_code) const {
    if (views_.empty() || views_[region].count == 0) return kNoView;
    std::uint32_t at = views_[region].first, count = views_[region].count;
    for (; count > 1; count -= count / 2)
        at += view_begin_[at + count / 2] <= outgoing_code ? count / 2 : 0;
    return region_count() + at;
}

float SdTreeSampler::pdf(std::uint32_t distribution, std::uint32_t code) const {
    return density(find(distribution, code));
}

SdTreeSampler::SquareSample SdTreeSampler::sample_square(std::uint32_t distribution, std::uint32_t pick,
                                                         std::uint32_t u0, std::uint32_t u1) const {
    const std::uint32_t mass = pick >> (32 - kMassBits);
    // The last cell whose probability begins at or before the pick is never empty.
    const Cell* const cell = last_before(range(by_mass(distribution, mass)), &Cell::mass_begin, mass);
    const std::uint32_t begin = cell[0].code_begin, area = cell[1].code_begin - begin;
    // Positions are on a grid of 2^23 steps per axis that nests in the quadtree's cells (centres of steps are exact
    // floats), so the code of the sampled point is in the sampled cell by construction.
    constexpr int kFineBits = 23 - kDirectionBits;
    const int shift = kFineBits + std::countr_zero(area) / 2;  // a cell is 2^shift steps wide
    const std::uint32_t x = (compact_bits(begin) << kFineBits) + (u0 >> (32 - shift));
    const std::uint32_t y = (compact_bits(begin >> 1) << kFineBits) + (u1 >> (32 - shift));
    const auto coordinate = [](std::uint32_t steps) {
        return static_cast<float>(static_cast<std::int32_t>(2 * steps + 1)) * 0x1p-24f;
    };
    return {{coordinate(x), coordinate(y)},
            spread_bits(x >> kFineBits) | (spread_bits(y >> kFineBits) << 1),
            density(cell)};
}

std::size_t SdTreeSampler::bytes() const {
    return region_bytes() + cells_.size() * sizeof(Cell) + 2 * region_mass_.size() * sizeof(region_mass_[0]) +
           2 * view_mass_.size() * sizeof(view_mass_[0]) + view_count() * 8 + views_.size() * sizeof(Views);
}

}  // namespace treefarm
