// SPDX-License-Identifier: Apache-2.0
#include "common/guiding/regions/region_sampler.h"

#include <algorithm>
#include <utility>

#include "common/math/elementary.h"

namespace treefarm {
namespace {

/// Grid steps of each axis of the cube: kMaxSpatialDepth / 3 halvings.
constexpr int kAxisBits = kMaxSpatialDepth / 3;
constexpr float kAxisSteps = static_cast<float>(1 << kAxisBits);

/// Halvings of each axis that one look-up in a table of 16 KB resolves.
constexpr int kTopBits = 4;

std::uint32_t axis_step(float position, float origin, float inverse_extent) {
    const float steps = (position - origin) * inverse_extent * kAxisSteps;
    const float inside = steps > 0.0f ? steps : 0.0f;  // NaN becomes 0
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(inside < kAxisSteps ? inside : kAxisSteps - 1.0f));
}

/// Index of a treelet's entry, by bit `bit` of each axis.
std::uint32_t octant_at(std::uint32_t x, std::uint32_t y, std::uint32_t z, int bit) {
    return ((x >> bit) & 1) | (((y >> bit) & 1) << 1) | (((z >> bit) & 1) << 2);
}

/// Index of the table's entry.
std::uint32_t top_index(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    constexpr int kShift = kAxisBits - kTopBits;
    return (x >> kShift) | (y >> kShift << kTopBits) | (z >> kShift << (2 * kTopBits));
}

}  // namespace

RegionSampler::RegionSampler(const RegionModel& model)
    : quantum_exponent_(model.quantum_exponent),
      bsdf_fraction_(model.bsdf_fraction),
      trained_(model.trained),
      origin_(model.origin),
      inverse_extent_(1.0f / model.extent),
      extent_(model.extent),
      light_probabilities_(model.light_probabilities),
      flux_(model.flux),
      next_event_(model.next_event),
      image_(model.image),
      thins_next_event_(
          std::any_of(model.next_event.begin(), model.next_event.end(), [](std::uint8_t code) { return code != 0; })),
      region_depth_(model.leaf_count()) {
    for (int depth = 0; depth <= kMaxSpatialDepth; ++depth)
        for (int axis = 0; axis < 3; ++axis)
            region_size_[static_cast<std::size_t>(depth)][axis] = extent_ * power_of_two(-(depth + 2 - axis) / 3);
    build_treelet(model, 0, 0);
    build_top();
}

/// Three levels of the binary tree (x, y, z) as one cache line of eight entries; a leaf above the third level fills all
/// entries below it.
std::uint32_t RegionSampler::build_treelet(const RegionModel& model, std::uint32_t node, int depth) {
    const auto index = static_cast<std::uint32_t>(treelets_.size());
    treelets_.emplace_back();
    for (std::uint32_t octant = 0; octant < 8; ++octant) {
        std::uint32_t at = node;
        int axis = 0;
        for (; axis < 3 && !model.nodes[at].is_leaf(); ++axis)
            at = model.nodes[at].child[(octant >> axis) & 1];
        std::uint32_t entry;
        if (model.nodes[at].is_leaf()) {
            entry = model.nodes[at].child[1] | kLeafFlag;
            region_depth_[model.nodes[at].child[1]] = static_cast<std::uint8_t>(depth + axis);
        } else {
            entry = build_treelet(model, at, depth + 3);
        }
        treelets_[index][octant] = entry;
    }
    return index;
}

/// Table of the nodes that the root's treelet and those below it lead to, for each of the cube's 2^(3 kTopBits) cells.
void RegionSampler::build_top() {
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

std::uint32_t RegionSampler::region(const Vec3& p) const {
    const std::uint32_t x = axis_step(p.x, origin_.x, inverse_extent_);
    const std::uint32_t y = axis_step(p.y, origin_.y, inverse_extent_);
    const std::uint32_t z = axis_step(p.z, origin_.z, inverse_extent_);
    std::uint32_t entry = top_[top_index(x, y, z)];
    for (int bit = kAxisBits - 1 - kTopBits; !(entry & kLeafFlag); --bit)
        entry = treelets_[entry][octant_at(x, y, z, bit)];
    return entry & ~kLeafFlag;
}

void RegionSampler::regions(const VectorBatch& positions, std::uint32_t count,
                            std::array<std::uint32_t, kDrawBatch>& found) const {
    alignas(64) std::array<std::uint32_t, kDrawBatch> x, y, z;
    for (std::uint32_t i = 0; i < whole_lanes(count); ++i) {
        x[i] = axis_step(positions.x[i], origin_.x, inverse_extent_);
        y[i] = axis_step(positions.y[i], origin_.y, inverse_extent_);
        z[i] = axis_step(positions.z[i], origin_.z, inverse_extent_);
    }
    // Leaves are unpredictable, so there is no branch on them.
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

std::size_t RegionSampler::region_bytes() const {
    return treelets_.size() * sizeof(treelets_[0]) + top_.size() * 4 + quantum_exponent_.size() * 2 +
           bsdf_fraction_.size() * 4 + light_probabilities_.size() * sizeof(LightProbabilities) + flux_.size() * 4 +
           region_depth_.size() + next_event_.size() + image_.inverse_levels.size() * 4;
}

}  // namespace treefarm
