// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "cli/tonemap.h"
#include "common/image/exr.h"

namespace treefarm {

/// The channels of one layer of an EXR image, by meaning.
struct ImageLayer {
    enum class Kind {
        colour,   ///< R, G, B
        vector,   ///< X, Y, Z
        uv,       ///< U, V
        numbers,  ///< I: indices of objects
        single,   ///< any single channel: Y, Z, A...
    };
    Kind kind = Kind::colour;
    std::vector<std::size_t> channels;  ///< indices of the channels, in the order of `kind`
};

/// Names of an image's layers; "" for channels without a dot.
std::vector<std::string> layer_names(const Image& image);

/// A layer of an image that was read from `file`. Throws InputError with a list of the layers if it does not exist or
/// cannot be shown.
ImageLayer find_image_layer(const Image& image, const std::string& layer, const std::string& file);

/// Settings of converting a layer to a picture.
struct PictureOptions {
    float exposure = 0;  ///< in stops: colours are multiplied by 2^exposure
    ToneMap tonemap = ToneMap::srgb;
    std::span<const float> alpha{};  ///< colours are divided by it before; empty: they are not
};

/// A layer as linear colours for a screen: colours by exposure and tone map; vectors up to length 1 as 0.5 + 0.5 v;
/// longer vectors and single channels scaled from their range to 0.1 to 1; alpha as it is; uv by fractional parts;
/// indices in distinct colours. Zero is always black. `range` receives the ranges that were scaled.
RgbImage picture_of_layer(const Image& image, const ImageLayer& layer, const PictureOptions& options,
                          std::string& range);

}  // namespace treefarm
