// SPDX-License-Identifier: Apache-2.0
#include "worker/integrators/path/tile_kernel.h"

namespace treefarm {
namespace {

constexpr TileKernel kKernels[] = {
    {{true}, render_with<NoGuide, DiffuseSurface, false, false>},
    {{false}, render_with<NoGuide, GeneralSurface, false, false>},
};

}  // namespace

std::span<const TileKernel> unguided_kernels() {
    return kKernels;
}

}  // namespace treefarm
