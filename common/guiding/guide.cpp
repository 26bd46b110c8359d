// SPDX-License-Identifier: Apache-2.0
#include "common/guiding/guide.h"

#include <bit>
#include <utility>

namespace treefarm {
namespace {

/// Grid steps of each axis of the cube: kMaxSpatialDepth / 3 halvings.
constexpr int kAxisBits = kMaxSpatialDepth / 3;
constexpr float kAxisSteps = static_cast<float>(1 << kAxisBits);

/// Halvings of each axis that a table does at once, by 16 KB.
constexpr int kTopBits = 4;

std::uint32_t axis_step(float position, float origin, float inverse_extent) {
    const float steps = (position - origin) * inverse_extent * kAxisSteps;
    const float inside = steps > 0.0f ? steps : 0.0f;  // also NaN
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(inside < kAxisSteps ? inside : kAxisSteps - 1.0f));
}

/// Which of a treelet's entries, at the axes' `bit`.
std::uint32_t octant_at(std::uint32_t x, std::uint32_t y, std::uint32_t z, int bit) {
    return ((x >> bit) & 1) | (((y >> bit) & 1) << 1) | (((z >> bit) & 1) << 2);
}

/// Which of the table's entries.
std::uint32_t top_index(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    constexpr int kShift = kAxisBits - kTopBits;
    return (x >> kShift) | (y >> kShift << kTopBits) | (z >> kShift << (2 * kTopBits));
}

}  // namespace

Guide::Guide(const SdTree& tree)
    : trained_(tree.trained),
      origin_(tree.origin),
      inverse_extent_(1.0f / tree.extent),
      extent_(tree.extent),
      view_fraction_(tree.view_fraction),
      quantum_exponent_(tree.quantum_exponent),
      bsdf_fraction_(tree.bsdf_fraction),
      light_probabilities_(tree.light_probabilities),
      region_depth_(tree.region_count()) {
    for (int depth = 0; depth <= kMaxSpatialDepth; ++depth)
        for (int axis = 0; axis < 3; ++axis)
            region_size_[static_cast<std::size_t>(depth)][axis] = extent_ * power_of_two(-(depth + 2 - axis) / 3);
    build_treelet(tree, 0, 0);
    build_top();

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

void Guide::add_views(const SdTree& tree) {
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

void Guide::add_distribution(const SdTree& tree, std::uint32_t distribution) {
    std::uint64_t code = 0;
    std::uint32_t mass = 0;
    for (std::uint32_t c = tree.cell_begin[distribution]; c < tree.cell_begin[distribution + 1]; ++c) {
        cells_.push_back({static_cast<std::uint32_t>(code), mass});
        code += std::uint64_t{1} << (2 * (kDirectionBits - tree.cell_depth[c]));
        mass += tree.cell_mass[c];
    }
    cells_.push_back({static_cast<std::uint32_t>(code), mass});
}

/// The binary search of a look-up runs between entries k and k + 1.
template <int bits>
void Guide::fill_lookups(LookupTable<bits>& by_mass, LookupTable<bits>& by_code, std::size_t first) const {
    constexpr std::uint32_t kSize = 1u << bits;
    const std::size_t end = cells_.size() - 1;
    std::uint32_t next_mass = 0, next_code = 0;
    for (std::size_t i = first; i < end; ++i) {
        const auto index = static_cast<std::uint32_t>(i);
        for (; next_mass < kSize && (next_mass << (kMassBits - bits)) < cells_[i + 1].mass_begin; ++next_mass)
            by_mass[next_mass] = index;
        // The last cell ends at 2^32, which its code does not show.
        for (; next_code < kSize &&
               (i + 1 == end || (next_code << (2 * kDirectionBits - bits)) < cells_[i + 1].code_begin);
             ++next_code)
            by_code[next_code] = index;
    }
    by_mass[kSize] = by_code[kSize] = static_cast<std::uint32_t>(end - 1);
}

/// Three levels of the binary tree (x, y, z) become one line of eight entries; a leaf above the third level fills all
/// the entries below it.
std::uint32_t Guide::build_treelet(const SdTree& tree, std::uint32_t node, int depth) {
    const auto index = static_cast<std::uint32_t>(treelets_.size());
    treelets_.emplace_back();
    for (std::uint32_t octant = 0; octant < 8; ++octant) {
        std::uint32_t at = node;
        int axis = 0;
        for (; axis < 3 && !tree.nodes[at].is_leaf(); ++axis)
            at = tree.nodes[at].child[(octant >> axis) & 1];
        std::uint32_t entry;
        if (tree.nodes[at].is_leaf()) {
            entry = tree.nodes[at].child[1] | kLeafFlag;
            region_depth_[tree.nodes[at].child[1]] = static_cast<std::uint8_t>(depth + axis);
        } else {
            entry = build_treelet(tree, at, depth + 3);
        }
        treelets_[index][octant] = entry;
    }
    return index;
}

/// Table of what the root's treelet and those below lead to, for each of the cube's 2^(3 kTopBits) cells.
void Guide::build_top() {
    top_.resize(std::size_t{1} << (3 * kTopBits));
    constexpr std::uint32_t kSide = 1u << kTopBits;
    for (std::uint32_t z = 0; z < kSide; ++z)
        for (std::uint32_t y = 0; y < kSide; ++y)
            for (std::uint32_t x = 0; x < kSide; ++x) {
                std::uint32_t entry = 0;
                for (int bit = kTopBits - 1; bit >= 0 && !(entry & kLeafFlag); --bit)
                    entry = treelets_[entry][octant_at(x, y, z, bit)];
                top_[x | y << kTopBits | z << (2 * kTopBits)] = entry;
            }
}

std::uint32_t Guide::region(const Vec3& p) const {
    const std::uint32_t x = axis_step(p.x, origin_.x, inverse_extent_);
    const std::uint32_t y = axis_step(p.y, origin_.y, inverse_extent_);
    const std::uint32_t z = axis_step(p.z, origin_.z, inverse_extent_);
    std::uint32_t entry = top_[top_index(x, y, z)];
    for (int bit = kAxisBits - 1 - kTopBits; !(entry & kLeafFlag); --bit)
        entry = treelets_[entry][octant_at(x, y, z, bit)];
    return entry & ~kLeafFlag;
}

void Guide::regions(const VectorBatch& positions, std::uint32_t count,
                    std::array<std::uint32_t, kDrawBatch>& found) const {
    alignas(64) std::array<std::uint32_t, kDrawBatch> x, y, z;
    for (std::uint32_t i = 0; i < whole_lanes(count); ++i) {
        x[i] = axis_step(positions.x[i], origin_.x, inverse_extent_);
        y[i] = axis_step(positions.y[i], origin_.y, inverse_extent_);
        z[i] = axis_step(positions.z[i], origin_.z, inverse_extent_);
    }
    // Whether an entry is a leaf nothing would predict: no branch asks.
    std::array<std::uint8_t, kDrawBatch> inner;
    std::uint32_t left = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        found[i] = top_[top_index(x[i], y[i], z[i])];
        inner[left] = static_cast<std::uint8_t>(i);
        left += found[i] < kLeafFlag;
    }
    for (int bit = kAxisBits - 1 - kTopBits; left != 0; --bit) {
        const std::uint32_t among = std::exchange(left, 0);
        for (std::uint32_t k = 0; k < among; ++k) {
            const std::uint8_t i = inner[k];
            found[i] = treelets_[found[i]][octant_at(x[i], y[i], z[i], bit)];
            inner[left] = i;
            left += found[i] < kLeafFlag;
        }
    }
    for (std::uint32_t i = 0; i < count; ++i)
        found[i] &= ~kLeafFlag;
}

float Guide::density(const Cell* cell) {
    const std::uint32_t mass = cell[1].mass_begin - cell[0].mass_begin;
    const std::uint32_t area = cell[1].code_begin - cell[0].code_begin;  // a power of two
    constexpr float kScale = kInvFourPi * static_cast<float>(1u << (2 * kDirectionBits - kMassBits));
    return kScale * static_cast<float>(static_cast<std::int32_t>(mass)) * power_of_two(-std::countr_zero(area));
}

std::uint32_t Guide::view(std::uint32_t region, std::uint32_t outgoing_code) const {
    if (views_.empty() || views_[region].count == 0) return kNoView;
    std::uint32_t at = views_[region].first, count = views_[region].count;
    for (; count > 1; count -= count / 2)
        at += view_begin_[at + count / 2] <= outgoing_code ? count / 2 : 0;
    return region_count() + at;
}

float Guide::pdf(std::uint32_t distribution, std::uint32_t code) const {
    return density(find(distribution, code));
}

Guide::SquareSample Guide::sample_square(std::uint32_t distribution, std::uint32_t pick, std::uint32_t u0,
                                         std::uint32_t u1) const {
    const std::uint32_t mass = pick >> (32 - kMassBits);
    // The last cell whose probability begins at or before the pick is never an empty one.
    const Cell* const cell = last_before(range(by_mass(distribution, mass)), &Cell::mass_begin, mass);
    const std::uint32_t begin = cell[0].code_begin, area = cell[1].code_begin - begin;
    // Positions are drawn on a grid of 2^23 steps per axis that nests in the quadtree's cells (steps' centres are exact
    // floats), so the code of the sampled point lies in the sampled cell by construction.
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

std::size_t Guide::bytes() const {
    return treelets_.size() * sizeof(treelets_[0]) + top_.size() * 4 + cells_.size() * sizeof(Cell) +
           2 * region_mass_.size() * sizeof(region_mass_[0]) + 2 * view_mass_.size() * sizeof(view_mass_[0]) +
           quantum_exponent_.size() * 2 + bsdf_fraction_.size() * 4 +
           light_probabilities_.size() * sizeof(LightProbabilities) + region_depth_.size() + view_count() * 8 +
           views_.size() * sizeof(Views);
}

}  // namespace treefarm
