// SPDX-License-Identifier: Apache-2.0
#include "worker/guides/kernels.h"
#include "worker/guides/plain_walk.h"

namespace treefarm {

std::span<const TileKernel> grid_kernels() {
    return kKernelsOf<PlainWalk<GridSampler>, GeneralSurface>;
}

}  // namespace treefarm
