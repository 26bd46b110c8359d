// SPDX-License-Identifier: Apache-2.0
#include "worker/integrators/path/tile_kernel.h"

namespace treefarm {

std::span<const TileKernel> diffuse_kernels() {
    return kKernelsOf<DiffuseSurface>;
}

}  // namespace treefarm
