// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/image/crop_window.h"
#include "common/math/vec.h"

namespace treefarm {

/// Limits of images that are read, longest side and number of values (pixels x channels), so that a damaged or hostile
/// header does not exhaust the memory.
inline constexpr int kMaxImageSide = 65536;
inline constexpr std::size_t kMaxImageValues = std::size_t{1} << 30;

/// Image with any number of named channels, as in an EXR file: "R", "G", "B", "variance.R", "albedo.G", ...
struct Image {
    int width = 0;   ///< pixels
    int height = 0;  ///< pixels
    std::vector<std::string> channel_names;
    /// Values in planes: channel by channel in the order of `channel_names`, each row by row from the top.
    std::vector<float> data;
    CropWindow crop{};  ///< position of the EXR file's data window inside its display window

    std::size_t pixel_count() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }

    /// Index of the channel of this name; empty if there is none.
    std::optional<std::size_t> find(const std::string& name) const;

    std::span<const float> channel(std::size_t index) const {
        return std::span(data).subspan(index * pixel_count(), pixel_count());
    }
    std::span<float> channel(std::size_t index) {
        return std::span(data).subspan(index * pixel_count(), pixel_count());
    }

    /// Appends a channel of zeros (width and height must be set) and returns its pixels. Invalidates spans returned
    /// before.
    std::span<float> add_channel(const std::string& name);
};

/// Image of linear colours (Rec. 709 primaries), row by row from the top.
struct RgbImage {
    int width = 0;   ///< pixels
    int height = 0;  ///< pixels
    std::vector<Rgb> pixels;

    RgbImage() = default;
    RgbImage(int w, int h, const Rgb& fill = Rgb(0.0f))
        : width(w), height(h), pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), fill) {}
};

/// Straight colours of premultiplied ones: divided by alpha where that is above 0. `alpha`: one for each pixel, or
/// none.
RgbImage straight_colours(RgbImage image, std::span<const float> alpha);

/// Alpha of an image's own colours, the channel A; empty if there is none.
std::span<const float> alpha_of(const Image& image);

/// The pixels of a crop window of `width` x `height`.
RgbImage cut_out(const RgbImage& image, const CropWindow& crop, int width, int height);

/// Name of a channel: "R" for the layer "", "variance.R" for the layer "variance".
std::string channel_name(const std::string& layer, const std::string& component);

/// The channels R, G and B of a layer, or its single channel Y as grey; empty if the image has neither.
std::optional<RgbImage> rgb_layer(const Image& image, const std::string& layer = "");

/// Appends the channels R, G and B of a layer. An image without size takes that of `rgb`; otherwise the sizes must be
/// equal.
void add_rgb_layer(Image& image, const std::string& layer, const RgbImage& rgb);

}  // namespace treefarm
