// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "common/guiding/regions/first_model.h"
#include "common/guiding/regions/region_model.h"

namespace treefarm {

/// The SD-tree as plain values (Mueller et al. 2017): regions that each have a quadtree over directions, T1. Fixed
/// during a pass; cell indices are equal on every rank. A region's cells (the leaves of its quadtree) are numbered in
/// Z-order, so the list of cell depths describes the quadtree.
///
/// Regions with view-dependent surfaces may also have a T2 (Cavus 2020, 2.5.5): an upper quadtree over outgoing
/// directions whose leaves ("views") each have a quadtree over incident directions. Neighbouring regions may share a
/// T2. A "distribution" is any of the quadtrees over incident directions: number r is that of region r, number
/// region_count() + v that of view v.
struct SdTree : RegionModel {
    // quantum_exponent and bsdf_fraction are per distribution; a view's fraction is the least remainder for the BSDF.
    static constexpr std::uint32_t kNoViews = 0xffffffffu;
    std::vector<std::uint32_t> view_set;    ///< per region: index of its T2, or kNoViews; in the order of regions, a T2
                                            ///< has consecutive regions; empty: no T2s
    std::vector<std::uint32_t> view_begin;  ///< T2s + 1 entries: views of T2 t are [view_begin[t], view_begin[t+1])
    std::vector<std::uint8_t> view_depth;   ///< per view, 0 to kMaxViewDepth; a T2's in Z-order
    std::vector<float> view_fraction;       ///< per view: probability of sampling it, [0, 1 - bsdf_fraction]
    std::vector<std::uint32_t>
        cell_begin;  ///< distributions + 1 entries: cells of distribution d are [cell_begin[d], cell_begin[d+1])
    std::vector<std::uint8_t> cell_depth;  ///< per cell, 1 to kMaxDirectionDepth
    std::vector<std::uint32_t>
        cell_mass;  ///< per cell: probability times 2^kMassBits; a distribution's sum to 2^kMassBits

    std::uint32_t distribution_count() const { return static_cast<std::uint32_t>(quantum_exponent.size()); }
    std::uint32_t view_count() const { return static_cast<std::uint32_t>(view_depth.size()); }
    std::uint32_t view_set_count() const {
        return view_begin.empty() ? 0 : static_cast<std::uint32_t>(view_begin.size() - 1);
    }
    std::uint32_t region_count() const { return distribution_count() - view_count(); }
    std::uint32_t cell_count() const { return static_cast<std::uint32_t>(cell_depth.size()); }
    bool operator==(const SdTree&) const = default;
};

inline constexpr int kMaxDirectionDepth = 16;  ///< cells of 4^-16 of the sphere
inline constexpr int kMaxViewDepth = 8;        ///< views of 4^-8 of the sphere

/// The tree before any pass: one region, directions in 4^4 equal cells.
SdTree initial_tree(const Box3& bounds, const FirstModel& settings);
inline SdTree initial_tree(const Box3& bounds, float radiance_scale, float bsdf_fraction = 0.5f) {
    return initial_tree(bounds, {radiance_scale, bsdf_fraction});
}

inline constexpr std::uint32_t kTreeMagic = 0x52544654;  ///< "TFTR"
/// Codec of the wire format. decode_tree() checks all structural rules and throws FormatError.
Bytes encode_tree(const SdTree& tree);
SdTree decode_tree(std::span<const std::uint8_t> bytes);

}  // namespace treefarm
