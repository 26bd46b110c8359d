#include "worker/integrator/tile_kernel.h"

namespace treefarm {

std::span<const TileKernel> general_kernels() {
    return kKernelsOf<GeneralSurface>;
}

}  // namespace treefarm
