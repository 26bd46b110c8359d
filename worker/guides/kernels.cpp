// SPDX-License-Identifier: Apache-2.0
#include "worker/guides/kernels.h"

namespace treefarm {
namespace {

constexpr KernelList kSdTree[] = {sd_tree_diffuse_kernels, sd_tree_general_kernels, sd_tree_viewed_kernels};
constexpr KernelList kGrid[] = {grid_kernels};
constexpr KernelList kQTable[] = {qtable_kernels};

}  // namespace

std::span<const KernelList> kernels_of(GuideKind kind) {
    switch (kind) {
        case GuideKind::sd_tree:
            return kSdTree;
        case GuideKind::grid:
            return kGrid;
        case GuideKind::qtable:
            return kQTable;
    }
    return {};
}

}  // namespace treefarm
