// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "worker/lights/light_tree.h"

namespace treefarm {

/// Builder of a light tree: a binary tree by the surface area orientation heuristic, whose nodes are then collapsed
/// into nodes of up to eight children.
class LightTreeBuilder {
  public:
    LightTreeBuilder(LightTree& tree, std::span<const LightBounds> bounds) : tree_(tree), bounds_(bounds) {}

    void build(std::span<const double> shares);

  private:
    struct Node {
        LightBounds bounds;
        std::uint32_t left = 0, right = 0;  ///< of a leaf: its entry, and unused
        bool leaf = false;
        double cost = 0;
    };
    static constexpr int kBuckets = 12;
    /// Depth from which nodes are split in halves, so that no tree is deeper than LightTree::kMostDepth.
    static constexpr int kMostSplits = 40;

    using Entries = std::span<std::uint32_t>;
    std::uint32_t binary(Entries entries, int depth);
    /// Sorts the entries by the best split, and returns how many are on its left.
    std::size_t split(Entries entries, const Box3& keys);
    std::size_t halve(Entries entries, int axis) const;
    /// Sort key of a split: the centre; at infinity the direction.
    Vec3 key(std::uint32_t entry) const;
    std::uint32_t join(std::uint32_t left, std::uint32_t right);

    std::uint32_t wide(std::vector<std::uint32_t> children, std::uint32_t parent);
    /// Replaces the costliest child by its children until there are `most`.
    void open(std::vector<std::uint32_t>& children, std::size_t most) const;
    void cut();
    void share_clusters(std::span<const double> shares);

    LightTree& tree_;
    std::span<const LightBounds> bounds_;
    std::vector<Node> nodes_;
    std::vector<double> lane_cost_;  ///< per lane of the wide nodes
    double least_area_ = 0;
};

}  // namespace treefarm
