// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worker/integrators/path/tile_kernel.h"

namespace treefarm {

std::span<const TileKernel> sd_tree_diffuse_kernels();
std::span<const TileKernel> sd_tree_general_kernels();
/// Kernels for SD-trees with views.
std::span<const TileKernel> sd_tree_viewed_kernels();
std::span<const TileKernel> grid_kernels();
std::span<const TileKernel> qtable_kernels();

}  // namespace treefarm
