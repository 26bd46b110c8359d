// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/guiding/sd_tree/sd_tree.h"
#include "common/guiding/sd_tree/sd_tree_sampler.h"
#include "common/guiding/sd_tree/tree_learner.h"
#include "common/guiding/sd_tree/tree_statistics.h"

namespace treefarm {

/// The SD-tree as a Guide (guides.h).
struct SdTreeGuide {
    using Model = SdTree;
    using Sampler = SdTreeSampler;
    using Learner = TreeLearner;

    static constexpr std::uint32_t kMagic = kTreeMagic;
    static constexpr bool kGrows = true;
    static constexpr int kKernels = 9;
    static constexpr bool kPlainKernels = true;
    static constexpr SamplerCost kCost = {2 * 65 * 4 + 40, 32, 8};

    static SdTree first(const Box3& bounds, const FirstModel& settings) { return initial_tree(bounds, settings); }
    static Bytes encode(const SdTree& tree) { return encode_tree(tree); }
    static SdTree decode(std::span<const std::uint8_t> bytes) { return decode_tree(bytes); }
    static ModelFigures figures(const SdTree& tree);

    static TreeStatistics statistics(const SdTree& tree) { return tree_statistics(tree); }
    static std::vector<double> cells_by_region(const SdTree& tree) { return treefarm::cells_by_region(tree); }
    static std::vector<float> density_map(const SdTree& tree, std::uint32_t distribution, int bits) {
        return treefarm::density_map(tree, distribution, bits);
    }
};

}  // namespace treefarm
