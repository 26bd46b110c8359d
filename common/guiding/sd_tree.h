// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/base/bytes.h"
#include "common/math/vec.h"

namespace treefarm {

/// How next event chooses an emitter in a region, in parts of kLightProbabilityOne, to which they sum: [0] by power
/// among all of them, [c + 1] among those of cluster c (worker/lights/light_clusters.h).
inline constexpr int kLightClusters = 15;
inline constexpr std::uint16_t kLightProbabilityOne = 1 << 15;
using LightProbabilities = std::array<std::uint16_t, kLightClusters + 1>;

/// The SD-tree as plain values (Mueller et al. 2017): a binary tree over a cube of space, axes cycling x, y, z,
/// midpoint splits, whose leaves ("regions") each hold a quadtree over directions, T1. Frozen for a pass; node, region
/// and cell indices mean the same on every rank. Regions are numbered in depth-first order, a region's cells (the
/// quadtree's leaves) in Z-order, so the list of cell depths is the quadtree.
///
/// Where view-dependent surfaces were met there may be a T2 as well (Cavus 2020, 2.5.5): an upper quadtree over
/// outgoing directions whose leaves ("views") each hold a quadtree over incident directions. Neighbouring regions may
/// share one. A "distribution" is one of those quadtrees, whichever: that of region r is number r, that of view v is
/// number region_count() + v.
struct SdTree {
    /// child[0] is the lower half. A leaf has child[0] == 0 and its region in child[1].
    struct Node {
        std::uint32_t child[2] = {0, 0};
        bool is_leaf() const { return child[0] == 0; }
    };

    std::uint32_t pass = 0;   ///< the pass that this tree guides and that builds the next one
    bool trained = false;     ///< false before the first pass: do not guide by it
    Vec3 origin{0.0f};        ///< lower corner of the cube
    float extent = 1.0f;      ///< edge of the cube, > 0
    std::vector<Node> nodes;  ///< [0] is the root
    static constexpr std::uint32_t kNoViews = 0xffffffffu;
    std::vector<std::uint32_t> view_set;  ///< per region: which T2 is its, or kNoViews; numbered in the regions' order,
                                          ///< each of regions that follow each other; empty if there is none
    std::vector<std::uint32_t> view_begin;  ///< T2s + 1 entries: views of T2 t are [view_begin[t], view_begin[t+1])
    std::vector<std::uint8_t> view_depth;   ///< per view, 0 to kMaxViewDepth; a T2's in Z-order
    std::vector<float> view_fraction;       ///< per view: probability of sampling it, [0, 1 - bsdf_fraction]
    std::vector<std::uint32_t>
        cell_begin;  ///< distributions + 1 entries: cells of distribution d are [cell_begin[d], cell_begin[d+1])
    std::vector<std::uint8_t> cell_depth;  ///< per cell, 1 to kMaxDirectionDepth
    std::vector<std::uint32_t>
        cell_mass;  ///< per cell: probability times 2^kMassBits; a distribution's sum to 2^kMassBits
    std::vector<std::int16_t> quantum_exponent;  ///< per distribution: records are counted in units of 2^e
    std::vector<float> bsdf_fraction;  ///< per region: probability of sampling the BSDF rather than the tree; per view:
                                       ///< the least that is left of it, (0, 1]

    /// Per region; empty: emitters are chosen by power, and nothing is learned.
    std::vector<LightProbabilities> light_probabilities;

    std::uint32_t distribution_count() const { return static_cast<std::uint32_t>(quantum_exponent.size()); }
    std::uint32_t view_count() const { return static_cast<std::uint32_t>(view_depth.size()); }
    std::uint32_t view_set_count() const {
        return view_begin.empty() ? 0 : static_cast<std::uint32_t>(view_begin.size() - 1);
    }
    std::uint32_t region_count() const { return distribution_count() - view_count(); }
    std::uint32_t cell_count() const { return static_cast<std::uint32_t>(cell_depth.size()); }
};

inline constexpr int kMassBits = 30;
inline constexpr int kMaxDirectionDepth = 16;  ///< cells of 4^-16 of the sphere
inline constexpr int kMaxViewDepth = 8;        ///< views of 4^-8 of the sphere
inline constexpr int kMaxSpatialDepth = 60;    ///< 20 halvings of each axis: floats have 24 bits

/// The tree before any pass: one region, directions in 4^4 equal cells, records in units that suit `radiance_scale`
/// (a typical emitted radiance), the BSDF sampled with probability `bsdf_fraction`. `with_views`: and a T2 of one view,
/// sampled with the probability `view_fraction`; 0: it is learned.
struct InitialTree {
    float radiance_scale = 1.0f;
    float bsdf_fraction = 0.5f;
    bool with_views = false;
    float view_fraction = 0.0f;
    bool with_lights = false;  ///< next event learns how to choose emitters
};
SdTree initial_tree(const Box3& bounds, const InitialTree& settings);
inline SdTree initial_tree(const Box3& bounds, float radiance_scale, float bsdf_fraction = 0.5f) {
    return initial_tree(bounds, {radiance_scale, bsdf_fraction});
}

/// A distribution counts its records in units of 2^e such that a record of average value is 2^15 to 2^16 units: fine
/// enough that rounding adds nothing measurable, with a cap (2^40 units) 2^24 times the average.
inline constexpr int kMeanRecordBits = 16;
inline constexpr int kMostQuantumExponent = 200;  ///< no mean of floats asks for one so far from 0
std::int16_t quantum_exponent_for(float mean_record);

/// Codec of the broadcast form. decode_tree checks every structural rule and throws FormatError.
Bytes encode_tree(const SdTree& tree);
SdTree decode_tree(std::span<const std::uint8_t> bytes);

}  // namespace treefarm
