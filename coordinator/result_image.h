// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/film/combine.h"
#include "common/image/exr.h"
#include "common/image/image.h"

namespace treefarm {

/// The combined image as channels: R, G, B; variance.* (of the mean, per channel); halfA.*, halfB.* (two independent
/// halves of the samples).
Image result_channels(const CombinedImage& image, int width, int height);

/// The combined image's R, G, B alone.
RgbImage result_colours(const CombinedImage& image, int width, int height);

}  // namespace treefarm
