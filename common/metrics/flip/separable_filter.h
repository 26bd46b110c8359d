// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/metrics/plane.h"

namespace treefarm {

/// Weights at the offsets -r, ..., r; their number is odd.
using Kernel = std::vector<float>;

/// Convolution: sum over (i, j) of across[i] down[j] plane(x + i, y + j). Beyond the border the nearest pixel counts,
/// so a plane may be smaller than the kernels; it must not be empty.
Plane filter_separable(const Plane& plane, const Kernel& across, const Kernel& down);

}  // namespace treefarm
