// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "cli/tonemap.h"
#include "common/image/exr.h"

namespace treefarm {

/// The channels of one layer of an EXR image, by what they stand for.
struct ImageLayer {
    enum class Kind {
        colour,   ///< R, G, B
        vector,   ///< X, Y, Z
        uv,       ///< U, V
        numbers,  ///< I: of objects
        single,   ///< any one channel: Y, Z, A...
    };
    Kind kind = Kind::colour;
    std::vector<std::size_t> channels;  ///< in that order
};

/// The layers of an image: "" for channels without a dot.
std::vector<std::string> layer_names(const Image& image);

/// A layer of an image that was read from `file`. Throws InputError that lists the layers where there is none of that
/// name, or none that can be shown.
ImageLayer find_image_layer(const Image& image, const std::string& layer, const std::string& file);

/// How a layer becomes a picture.
struct PictureOptions {
    float exposure = 0;  ///< stops: colours are multiplied by 2^exposure
    ToneMap tonemap = ToneMap::srgb;
};

/// A layer as linear colours of a screen: colours by exposure and tone map; vectors of at most length 1 as 0.5 + 0.5 v,
/// longer ones and single channels stretched from their least to their greatest value, alpha as it is, uv by their
/// fractions, numbers each in a colour of its own. Nothing (0) is black in all of them. `range` says what was
/// stretched.
RgbImage picture_of_layer(const Image& image, const ImageLayer& layer, const PictureOptions& options,
                          std::string& range);

}  // namespace treefarm
