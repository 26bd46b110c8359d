// SPDX-License-Identifier: Apache-2.0
#include "worker/integrators/path/tile_kernel.h"

namespace treefarm {

std::span<const TileKernel> viewed_kernels() {
    return kTreeKernelsOf<ViewedSurface>;
}

}  // namespace treefarm
