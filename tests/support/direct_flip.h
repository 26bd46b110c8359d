// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/image/image.h"

namespace treefarm {

/// FLIP of one pixel as Andersson et al. 2020 define it: two-dimensional filters, in double, without code of
/// common/metrics.
double direct_flip(const RgbImage& image, const RgbImage& reference, int x, int y, double ppd);

}  // namespace treefarm
