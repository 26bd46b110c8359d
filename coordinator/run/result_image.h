// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/film/aov_film.h"
#include "common/film/combine.h"
#include "common/image/exr.h"
#include "common/image/image.h"

namespace treefarm {

/// An image with the form in which each of its channels is stored.
struct StoredChannels {
    Image image;
    std::vector<PixelType> types;
};

/// The combined image as channels: R, G, B; variance.* (of the mean, per channel); halfA.*, halfB.* (two independent
/// halves of the samples); then the AOVs. `half`: colours, and AOVs that are not precise, as 16-bit floats.
StoredChannels result_channels(const CombinedImage& image, std::span<const AovChannel> aovs, int width, int height,
                               bool half);

/// The combined image's R, G, B alone.
RgbImage result_colours(const CombinedImage& image, int width, int height);

}  // namespace treefarm
