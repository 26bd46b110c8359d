// SPDX-License-Identifier: Apache-2.0
#include "worker/lights/light_tree_builder.h"

#include <algorithm>
#include <limits>

namespace treefarm {
namespace {

double diagonal2(const Box3& box) {
    if (box.isEmpty()) return 0.0;
    const Imath::V3d size = Imath::V3d(box.max) - Imath::V3d(box.min);
    return size.dot(size);
}

/// Least area of a box in the tree's cost: boxes of lamps in a line have none of their own.
double least_area(const Box3& box) {
    const double area = 1e-3 * diagonal2(box);
    return area > 0 ? area : 1.0;
}

}  // namespace

LightTree::LightTree(std::span<const LightBounds> bounds, std::span<const double> shares)
    : space_(bounds), shares_(shares) {
    LightTreeBuilder(*this, bounds).build(shares);
}

void LightTreeBuilder::build(std::span<const double> shares) {
    std::vector<std::uint32_t> near, far;
    Box3 box;
    for (std::uint32_t entry = 0; entry < bounds_.size(); ++entry) {
        if (!(bounds_[entry].amount > 0 && shares[entry] > 0)) continue;
        (bounds_[entry].at_infinity ? far : near).push_back(entry);
        box.extendBy(bounds_[entry].box);
    }
    least_area_ = least_area(box);
    nodes_.reserve(2 * (near.size() + far.size()));
    tree_.lane_of_entry_.assign(bounds_.size(), LightTree::kNowhere);
    std::vector<std::uint32_t> root;
    if (!far.empty()) {
        root.push_back(binary(far, 0));
        constexpr std::size_t kFarLanes = 4;  // of the root, that emitters at infinity may have
        if (!near.empty()) open(root, kFarLanes);
    }
    if (!near.empty()) {
        std::vector<std::uint32_t> others{binary(near, 0)};
        open(others, LightLanes::kCount - root.size());
        root.insert(root.end(), others.begin(), others.end());
    } else {
        open(root, LightLanes::kCount);
    }
    wide(std::move(root), LightTree::kNowhere);
    tree_.nodes_.shrink_to_fit();
    tree_.links_.shrink_to_fit();
    cut();
    share_clusters(shares);
}

Vec3 LightTreeBuilder::key(std::uint32_t entry) const {
    const LightBounds& b = bounds_[entry];
    return b.at_infinity ? b.cone.axis : (b.box.min * 0.5f + b.box.max * 0.5f);
}

std::uint32_t LightTreeBuilder::binary(Entries entries, int depth) {
    if (entries.size() == 1) {
        Node leaf;
        leaf.bounds = bounds_[entries[0]];
        leaf.left = entries[0];
        leaf.leaf = true;
        leaf.cost = sampling_cost(leaf.bounds, least_area_);
        nodes_.push_back(leaf);
        return static_cast<std::uint32_t>(nodes_.size() - 1);
    }
    Box3 keys;
    for (const std::uint32_t entry : entries)
        keys.extendBy(key(entry));
    const std::size_t left = entries.size() == 2   ? 1
                             : depth < kMostSplits ? split(entries, keys)
                                                   : halve(entries, static_cast<int>(keys.majorAxis()));
    const std::uint32_t first = binary(entries.first(left), depth + 1);
    return join(first, binary(entries.subspan(left), depth + 1));
}

std::uint32_t LightTreeBuilder::join(std::uint32_t left, std::uint32_t right) {
    Node node;
    node.bounds = joined(nodes_[left].bounds, nodes_[right].bounds);
    node.left = left;
    node.right = right;
    node.cost = sampling_cost(node.bounds, least_area_);
    nodes_.push_back(node);
    return static_cast<std::uint32_t>(nodes_.size() - 1);
}

std::size_t LightTreeBuilder::halve(Entries entries, int axis) const {
    const auto before = [&](std::uint32_t a, std::uint32_t b) {
        const float of_a = key(a)[axis], of_b = key(b)[axis];
        return of_a != of_b ? of_a < of_b : a < b;
    };
    const auto middle = entries.begin() + static_cast<std::ptrdiff_t>(entries.size() / 2);
    std::nth_element(entries.begin(), middle, entries.end(), before);
    return entries.size() / 2;
}

std::size_t LightTreeBuilder::split(Entries entries, const Box3& keys) {
    struct Bucket {
        LightBounds bounds;
        std::size_t count = 0;

        void add(const LightBounds& more, std::size_t number) {
            bounds = count == 0 ? more : joined(bounds, more);
            count += number;
        }
    };
    const Vec3 size = keys.max - keys.min;
    const float longest = std::max(size.x, std::max(size.y, size.z));
    if (!(longest > 0.0f)) return halve(entries, 0);
    const auto bucket_of = [&](std::uint32_t entry, int axis) {
        const float along = (key(entry)[axis] - keys.min[axis]) / size[axis];
        return std::clamp(static_cast<int>(along * float(kBuckets)), 0, kBuckets - 1);
    };
    Box3 box;
    for (const std::uint32_t entry : entries)
        box.extendBy(bounds_[entry].box);
    const double floor = least_area(box);
    double best = std::numeric_limits<double>::infinity();
    int best_axis = -1, best_bucket = 0;
    for (int axis = 0; axis < 3; ++axis) {
        if (!(size[axis] > 0.0f)) continue;
        std::array<Bucket, kBuckets> buckets;
        for (const std::uint32_t entry : entries)
            buckets[static_cast<std::size_t>(bucket_of(entry, axis))].add(bounds_[entry], 1);
        std::array<double, kBuckets> below{};
        Bucket sum;
        for (std::size_t b = 0; b + 1 < kBuckets; ++b) {
            if (buckets[b].count > 0) sum.add(buckets[b].bounds, buckets[b].count);
            below[b] = sum.count > 0 ? sampling_cost(sum.bounds, floor) : -1.0;
        }
        sum = {};
        for (std::size_t b = kBuckets - 1; b > 0; --b) {
            if (buckets[b].count > 0) sum.add(buckets[b].bounds, buckets[b].count);
            if (sum.count == 0 || below[b - 1] < 0) continue;
            // Thin nodes cost more, by the ratio of the longest side to theirs.
            const double cost =
                (below[b - 1] + sampling_cost(sum.bounds, floor)) * double(longest) / double(size[axis]);
            if (!(cost < best)) continue;
            best = cost;
            best_axis = axis;
            best_bucket = static_cast<int>(b);
        }
    }
    if (best_axis < 0) return halve(entries, static_cast<int>(keys.majorAxis()));
    const auto right = std::stable_partition(
        entries.begin(), entries.end(), [&](std::uint32_t entry) { return bucket_of(entry, best_axis) < best_bucket; });
    return static_cast<std::size_t>(right - entries.begin());
}

void LightTreeBuilder::open(std::vector<std::uint32_t>& children, std::size_t most) const {
    while (children.size() < most) {
        std::size_t costliest = children.size();
        for (std::size_t i = 0; i < children.size(); ++i) {
            if (nodes_[children[i]].leaf) continue;
            if (costliest == children.size() || nodes_[children[i]].cost > nodes_[children[costliest]].cost)
                costliest = i;
        }
        if (costliest == children.size()) return;
        const Node& node = nodes_[children[costliest]];
        children[costliest] = node.left;
        children.push_back(node.right);
    }
}

std::uint32_t LightTreeBuilder::wide(std::vector<std::uint32_t> children, std::uint32_t parent) {
    const auto index = static_cast<std::uint32_t>(tree_.nodes_.size());
    tree_.nodes_.emplace_back();
    LightTree::Link link;
    link.parent = parent;
    link.cluster.fill(LightTree::kNoCluster);
    tree_.links_.push_back(link);
    lane_cost_.resize(lane_cost_.size() + LightLanes::kCount, -1.0);
    for (std::size_t i = 0; i < children.size(); ++i) {
        const Node& node = nodes_[children[i]];
        const std::uint32_t lane = LightTree::lane_of(index, static_cast<int>(i));
        tree_.space_.set(tree_.nodes_[index], static_cast<int>(i), node.bounds);
        if (node.leaf) {
            tree_.nodes_[index].child[i] = LightLanes::kLeaf | node.left;
            tree_.lane_of_entry_[node.left] = lane;
            continue;
        }
        // Emitters at infinity are separated first: a sun may be beside a sky.
        lane_cost_[lane] = node.bounds.at_infinity ? 1e30 + node.cost : node.cost;
        std::vector<std::uint32_t> below{node.left, node.right};
        open(below, LightLanes::kCount);
        const std::uint32_t child = wide(std::move(below), lane);
        tree_.nodes_[index].child[i] = child;
    }
    return index;
}

void LightTreeBuilder::cut() {
    const auto lanes_of = [&](std::uint32_t node) {
        std::vector<std::uint32_t> lanes;
        for (int k = 0; k < LightLanes::kCount; ++k)
            if (tree_.nodes_[node].amount[k] > 0.0f) lanes.push_back(LightTree::lane_of(node, k));
        return lanes;
    };
    std::vector<std::uint32_t>& heads = tree_.heads_;
    heads = lanes_of(0);
    std::vector<double> cost = lane_cost_;
    for (;;) {
        const auto costliest = std::max_element(heads.begin(), heads.end(),
                                                [&](std::uint32_t a, std::uint32_t b) { return cost[a] < cost[b]; });
        if (costliest == heads.end() || cost[*costliest] < 0) break;
        const std::uint32_t child =
            tree_.nodes_[*costliest / LightLanes::kCount].child[*costliest % LightLanes::kCount];
        const std::vector<std::uint32_t> below = lanes_of(child);
        if (heads.size() - 1 + below.size() > kLightClusters) {
            cost[*costliest] = -1.0;
            continue;
        }
        heads.erase(costliest);
        heads.insert(heads.end(), below.begin(), below.end());
    }
    for (std::size_t c = 0; c < heads.size(); ++c)
        tree_.links_[heads[c] / LightLanes::kCount].cluster[heads[c] % LightLanes::kCount] =
            static_cast<std::uint8_t>(c);
}

void LightTreeBuilder::share_clusters(std::span<const double> shares) {
    std::array<double, kLightClusters> sums{};
    for (std::uint32_t entry = 0; entry < bounds_.size(); ++entry)
        if (const std::uint8_t cluster = tree_.cluster_of(entry); cluster != LightTree::kNoCluster)
            sums[cluster] += shares[entry];
    for (std::size_t c = 0; c < sums.size(); ++c)
        tree_.fixed_[c] = static_cast<float>(sums[c]);
}

}  // namespace treefarm
