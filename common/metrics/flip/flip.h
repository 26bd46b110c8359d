// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/image/image.h"
#include "common/metrics/flip/kernels.h"
#include "common/metrics/plane.h"

namespace treefarm {

/// FLIP per pixel, in [0, 1]: the difference that a viewer sees when two images alternate on one screen
/// (Andersson et al. 2020, "FLIP: A Difference Evaluator for Alternating Images"). Linear colours, clamped to [0, 1];
/// they must be finite, and the images of equal size and not empty. `ppd`: pixels per degree, in [1, 1000].
Plane flip(const RgbImage& image, const RgbImage& reference, double ppd = kDefaultPixelsPerDegree);

}  // namespace treefarm
