// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "worker/lights/discrete_table.h"
#include "worker/lights/flat_lights.h"

namespace treefarm {

/// Next 64 random bits from the given ones (splitmix64, Steele et al. 2014).
inline std::uint64_t next_bits(std::uint64_t bits) {
    bits += 0x9e3779b97f4a7c15u;
    bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9u;
    bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
    return bits ^ (bits >> 31);
}

/// Choice among many emitters by their estimated contribution to a point, after Conty Estevez and Kulla 2018. From the
/// root of a hierarchy of bounds on, one of up to eight children is chosen in proportion to its estimate. A fraction of
/// all draws ignores the estimates, so that an estimate's error cannot starve an emitter.
///
/// Regions learn the probabilities of clusters of emitters: up to 15 nodes below the root.
class LightTree {
  public:
    /// `shares` as in FlatLights. At least one emitter has a share, and at least one an amount.
    LightTree(std::span<const LightBounds> bounds, std::span<const double> shares);

    /// Chooses an emitter by 64 random bits.
    LightPick pick(std::uint64_t bits, const LightReceiver& receiver) const;

    /// The LightPick of an entry, as if pick() had chosen it.
    LightPick probability(std::uint32_t entry, const LightReceiver& receiver) const;

    std::size_t node_count() const { return nodes_.size(); }
    /// Memory in bytes.
    std::size_t bytes() const;
    int cluster_count() const { return static_cast<int>(heads_.size()); }
    /// Cluster of an entry that has an amount.
    std::uint8_t cluster_of(std::uint32_t entry) const;

  private:
    friend class LightTreeBuilder;

    static constexpr std::uint8_t kNoCluster = 0xff;
    static constexpr std::uint32_t kNowhere = 0xffffffffu;
    static constexpr std::size_t kMostDepth = 64;

    /// Link to a node's parent: `parent` as a lane, and the clusters that begin in the node's own lanes.
    struct Link {
        std::uint32_t parent = kNowhere;
        std::array<std::uint8_t, LightLanes::kCount> cluster;
    };
    /// Index of a lane of a node.
    static std::uint32_t lane_of(std::uint32_t node, int lane) {
        return node * LightLanes::kCount + static_cast<std::uint32_t>(lane);
    }

    /// Probabilities on a descent: down to the cluster, and below it.
    struct Descent {
        float above = 1.0f, below = 1.0f;
        std::uint8_t cluster = kNoCluster;

        void step(float probability, std::uint8_t begins) {
            if (cluster == kNoCluster) {
                above *= probability;
                cluster = begins;
            } else {
                below *= probability;
            }
        }
    };
    LightPick completed(std::uint32_t entry, const Descent& descent, const LightProbabilities* learned) const;

    /// Entry found by random bits below a node, or LightPick::kNone; adds the steps to `way`.
    std::uint32_t descend(std::uint32_t node, std::uint64_t bits, const Vec3& p, const LightReceiver& receiver,
                          Descent& descent) const;
    std::uint32_t pick_learned(std::uint64_t bits, std::uint32_t share, const Vec3& p,
                               const LightReceiver& receiver) const;

    LightSpace space_;
    std::vector<LightLanes> nodes_;
    std::vector<Link> links_;
    std::vector<std::uint32_t> lane_of_entry_;   ///< per entry: its lane, or kNowhere
    std::vector<std::uint32_t> heads_;           ///< per cluster: its first lane
    std::array<float, kLightClusters> fixed_{};  ///< per cluster: its probability in the defensive choice
    DiscreteTable shares_;                       ///< the defensive choice
};

}  // namespace treefarm
