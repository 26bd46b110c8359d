// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/film/aov_film.h"
#include "common/film/combine.h"
#include "common/image/exr.h"
#include "common/image/image.h"

namespace treefarm {

/// An image with the storage format of each of its channels.
struct StoredChannels {
    Image image;
    std::vector<PixelType> types;
};

/// Combined image as channels: R, G, B; variance.* (of the mean, per channel); halfA.*, halfB.* (two independent halves
/// of the samples); then the AOVs. `half`: colours, and AOVs that are not precise, as 16-bit floats.
StoredChannels result_channels(const CombinedImage& image, std::span<const AovChannel> aovs, int width, int height,
                               bool half);

/// R, G, B of the combined image.
RgbImage result_colours(const CombinedImage& image, int width, int height);

/// PNG of the combined image; if the channel A is among the AOVs, RGBA with straight colours. Throws RunError.
std::vector<std::uint8_t> encode_picture(const CombinedImage& image, std::span<const AovChannel> aovs, int width,
                                         int height);

}  // namespace treefarm
