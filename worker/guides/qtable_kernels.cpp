// SPDX-License-Identifier: Apache-2.0
#include "worker/guides/kernels.h"
#include "worker/guides/qtable_walk.h"

namespace treefarm {

std::span<const TileKernel> qtable_kernels() {
    return kKernelsOf<QTableWalk, GeneralSurface>;
}

}  // namespace treefarm
