// SPDX-License-Identifier: Apache-2.0
#include "worker/guides/kernels.h"
#include "worker/guides/sd_tree_walk.h"

namespace treefarm {

std::span<const TileKernel> sd_tree_general_kernels() {
    return kKernelsOf<SdTreeWalk<false>, GeneralSurface>;
}

}  // namespace treefarm
