// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/image/image.h"

namespace treefarm {

/// Signed relative difference of luminance, (a - b) / (|b| + 0.01), as false colour: blue where the image is too dark,
/// white where both agree, red where it is too bright; `range` and beyond are fully coloured. Magenta marks pixels that
/// are NaN or infinite in either. Linear colours for write_png. Throws InputError if the sizes differ.
RgbImage difference_image(const RgbImage& image, const RgbImage& reference, double range = 0.5);

}  // namespace treefarm
