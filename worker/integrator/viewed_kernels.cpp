#include "worker/integrator/tile_kernel.h"

namespace treefarm {

std::span<const TileKernel> viewed_kernels() {
    return kTreeKernelsOf<ViewedSurface>;
}

}  // namespace treefarm
