// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/film/combine.h"
#include "common/image/image.h"

namespace treefarm {

/// Pixels of a pass in progress: sums over their samples; a pixel is complete or empty.
struct PassPixels {
    struct Pixel {
        Rgb mean{0.0f};
        float samples = 0;  ///< 0: no results yet
    };
    std::vector<Pixel> pixels;
};

/// Reduces the film of a pass in progress to the needs of a preview: 16 of 112 bytes per pixel.
PassPixels pass_pixels(std::span<const PixelEstimate> film);

/// The image so far, for viewing only: finished passes (`image`, of `spp` samples; empty before the first) and the
/// results of the pass in progress, weighted by their numbers of samples. Pixels without samples are black.
RgbImage preview_image(const CombinedImage& image, std::uint32_t spp, const PassPixels& pass, int width, int height);

}  // namespace treefarm
