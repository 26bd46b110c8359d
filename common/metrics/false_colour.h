// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/image/image.h"
#include "common/metrics/plane.h"

namespace treefarm {

/// Colour of t in [0, 1] by the formula of Green 2011 ("A colour scheme for the display of astronomical intensity
/// images", Bull. Astr. Soc. India 39, 289; start 0.5, -1.5 rotations, hue 1, gamma 1): from black over blue, green and
/// pink to white, ever brighter. Linear, for write_png.
Rgb cubehelix(float t);

/// A map of values in [0, 1] as false colour. Magenta marks NaN.
RgbImage false_colour(const Plane& map);

}  // namespace treefarm
