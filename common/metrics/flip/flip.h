// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/image/image.h"
#include "common/metrics/flip/kernels.h"
#include "common/metrics/plane.h"

namespace treefarm {

/// FLIP per pixel, in [0, 1]: how much a viewer who alternates between two images on one screen sees them differ
/// (Andersson et al. 2020, "FLIP: A Difference Evaluator for Alternating Images"). Colours are linear and are clamped
/// to [0, 1]; they must be finite, the images of one size and not empty. `ppd` in [1, 1000] pixels per degree.
Plane flip(const RgbImage& image, const RgbImage& reference, double ppd = kDefaultPixelsPerDegree);

}  // namespace treefarm
