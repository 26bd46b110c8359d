// SPDX-License-Identifier: Apache-2.0
#include "worker/lights/light_tree.h"

#include "common/base/prefetch.h"

namespace treefarm {
namespace {

constexpr float kEstimated = 1.0f - kDefensive;
constexpr float kPerLearned = 1.0f / static_cast<float>(kLightProbabilityOne);
static_assert(kDefensive == 0.125f, "three bits choose it");

}  // namespace

std::size_t LightTree::bytes() const {
    return nodes_.capacity() * sizeof(LightLanes) + links_.capacity() * sizeof(Link) +
           lane_of_entry_.capacity() * sizeof(std::uint32_t) + shares_.size() * sizeof(std::uint64_t);
}

std::uint8_t LightTree::cluster_of(std::uint32_t entry) const {
    std::uint8_t cluster = kNoCluster;
    for (std::uint32_t lane = lane_of_entry_[entry]; lane != kNowhere;
         lane = links_[lane / LightLanes::kCount].parent) {
        const std::uint8_t begins = links_[lane / LightLanes::kCount].cluster[lane % LightLanes::kCount];
        if (begins != kNoCluster) cluster = begins;
    }
    return cluster;
}

LightPick LightTree::completed(std::uint32_t entry, const Descent& descent, const LightProbabilities* learned) const {
    const float by_tree = descent.above * descent.below, defensive = kDefensive * shares_.probability(entry);
    LightPick pick{entry, kEstimated * by_tree + defensive, 0, 1.0f};
    if (!learned || descent.cluster == kNoCluster) return pick;
    const float tree = static_cast<float>((*learned)[0]) * kPerLearned;
    const float cluster = static_cast<float>((*learned)[descent.cluster + 1u]) * kPerLearned;
    pick.probability = kEstimated * (tree * by_tree + cluster * descent.below) + defensive;
    pick.cluster = descent.cluster;
    pick.cluster_probability = kEstimated * (tree * descent.above + cluster) + kDefensive * fixed_[descent.cluster];
    return pick;
}

std::uint32_t LightTree::descend(std::uint32_t node, std::uint64_t bits, const Vec3& p, const LightReceiver& receiver,
                                 Descent& descent) const {
    for (;;) {
        bits = next_bits(bits);
        const LightWidths widths(nodes_[node], p, receiver);
        const int lane = widths.pick(static_cast<std::uint32_t>(bits >> 33));
        if (lane == LightLanes::kCount) return LightPick::kNone;
        descent.step(widths.probability(lane), links_[node].cluster[static_cast<std::size_t>(lane)]);
        const std::uint32_t child = nodes_[node].child[lane];
        if (child & LightLanes::kLeaf) return child & ~LightLanes::kLeaf;
        node = child;
    }
}

std::uint32_t LightTree::pick_learned(std::uint64_t bits, std::uint32_t share, const Vec3& p,
                                      const LightReceiver& receiver) const {
    const LightProbabilities& learned = *receiver.probabilities;
    std::uint32_t cluster = 0;
    while (cluster + 1 < heads_.size() && share >= learned[cluster + 1])
        share -= learned[++cluster];
    // A learned value outside of any cluster's interval chooses no emitter.
    if (cluster >= heads_.size() || share >= learned[cluster + 1]) return LightPick::kNone;
    const std::uint32_t head = heads_[cluster];
    const std::uint32_t child = nodes_[head / LightLanes::kCount].child[head % LightLanes::kCount];
    Descent descent;
    return child & LightLanes::kLeaf ? child & ~LightLanes::kLeaf : descend(child, bits, p, receiver, descent);
}

LightPick LightTree::pick(std::uint64_t bits, const LightReceiver& receiver) const {
    const Vec3 p = space_.normalised(receiver.p);
    std::uint32_t entry;
    const bool defensive = bits >> 61 == 0;
    bits = next_bits(bits);
    if (defensive) {
        entry = shares_.pick(static_cast<std::uint32_t>(bits >> 32));
    } else {
        const LightProbabilities* const learned = receiver.probabilities;
        const auto share = static_cast<std::uint32_t>(bits >> 49);
        if (!learned || share < (*learned)[0]) {
            Descent descent;
            entry = descend(0, bits, p, receiver, descent);
            return entry == LightPick::kNone ? LightPick{} : completed(entry, descent, learned);
        }
        entry = pick_learned(bits, share - (*learned)[0], p, receiver);
    }
    return entry == LightPick::kNone ? LightPick{} : probability(entry, receiver);
}

LightPick LightTree::probability(std::uint32_t entry, const LightReceiver& receiver) const {
    std::array<std::uint32_t, kMostDepth> lanes;
    std::size_t depth = 0;
    for (std::uint32_t lane = lane_of_entry_[entry]; lane != kNowhere;
         lane = links_[lane / LightLanes::kCount].parent) {
        lanes[depth++] = lane;
        prefetch_line(&nodes_[lane / LightLanes::kCount]);
    }
    Descent descent;
    if (depth == 0) descent.above = 0.0f;
    const Vec3 p = space_.normalised(receiver.p);
    while (depth > 0) {
        const std::uint32_t lane = lanes[--depth], node = lane / LightLanes::kCount,
                            of_node = lane % LightLanes::kCount;
        const LightWidths widths(nodes_[node], p, receiver);
        descent.step(widths.probability(static_cast<int>(of_node)), links_[node].cluster[of_node]);
    }
    return completed(entry, descent, receiver.probabilities);
}

}  // namespace treefarm
