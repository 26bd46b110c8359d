// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/film/combine.h"
#include "common/image/image.h"

namespace treefarm {

/// Pixels of a pass in hand: sums over their samples, since a pixel is whole or empty.
struct PartialPass {
    struct Pixel {
        Rgb mean{0.0f};
        float samples = 0;  ///< 0: nothing has come
    };
    std::vector<Pixel> pixels;
};

/// Reduces the film of a pass in hand to what a preview needs: 16 bytes of 112 a pixel.
PartialPass partial_pass(std::span<const PixelEstimate> film);

/// The image so far: finished passes (`image`, of `spp` samples; empty before the first) and what has come of the pass
/// in hand, by their numbers of samples. Pixels that nothing is known of are black. For looking at only.
RgbImage preview_image(const CombinedImage& image, std::uint32_t spp, const PartialPass& pass, int width, int height);

}  // namespace treefarm
