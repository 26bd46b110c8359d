// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "cli/tonemap.h"
#include "common/image/exr.h"

namespace treefarm {

/// Channels of one layer of an EXR image, with their meaning.
struct ImageLayer {
    enum class Kind {
        colour,   ///< R, G, B
        vector,   ///< X, Y, Z
        uv,       ///< U, V
        numbers,  ///< I: numbers of objects
        single,   ///< any single channel: Y, Z, A...
    };
    Kind kind = Kind::colour;
    std::vector<std::size_t> channels;  ///< in the order of the kind
};

/// Names of an image's layers; "" for channels without a dot.
std::vector<std::string> layer_names(const Image& image);

/// Layer of an image that was read from `file`. Throws InputError, with the list of layers, if there is none of that
/// name or it cannot be shown.
ImageLayer find_image_layer(const Image& image, const std::string& layer, const std::string& file);

/// Settings for showing a layer.
struct PictureOptions {
    float exposure = 0;  ///< in stops: colours are multiplied by 2^exposure
    ToneMap tonemap = ToneMap::srgb;
};

/// Layer as linear display colours: colours by exposure and tone map; vectors of at most length 1 as 0.5 + 0.5 v;
/// longer vectors and single channels stretched from their minimum to their maximum, alpha unchanged; uv by their
/// fractions; each number in a colour of its own. 0 is black in all of them. `range` is set to the stretched range.
RgbImage picture_of_layer(const Image& image, const ImageLayer& layer, const PictureOptions& options,
                          std::string& range);

}  // namespace treefarm
