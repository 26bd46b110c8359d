// SPDX-License-Identifier: Apache-2.0
#include "worker/guides/kernels.h"
#include "worker/guides/sd_tree_walk.h"

namespace treefarm {

std::span<const TileKernel> sd_tree_diffuse_kernels() {
    return kKernelsOf<SdTreeWalk<false>, DiffuseSurface>;
}

}  // namespace treefarm
