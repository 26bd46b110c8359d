// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/image/image.h"

namespace treefarm {

/// Storage type of an EXR channel. All types are read as float; integers above 2^24 are rounded.
enum class PixelType { half, float32, uint32 };

/// Text attributes of the header: "treefarm.spp" -> "64".
using Attributes = std::map<std::string, std::string>;

struct ExrImage {
    Image image;
    std::vector<PixelType> types;  ///< one per channel of `image`; half implies a rounding error
    Attributes attributes;         ///< of type string
};

/// Reads the channels for which `wanted` holds (all without a function) over the file's data window; its position is
/// set if it is a part of the display window. Supports scan lines and tiles and any compression; of a multi-part file
/// the first part. Throws InputError with the file's name if it is missing, not EXR, damaged, cut short, subsampled,
/// without such channels, or too large (more than `most_pixels`: before anything is allocated).
ExrImage read_exr(const std::filesystem::path& path, const std::function<bool(const std::string&)>& wanted = {},
                  std::uint64_t most_pixels = ~0ull);

/// Names of a file's channels, in its (alphabetical) order. Throws InputError like read_exr().
std::vector<std::string> exr_channel_names(const std::filesystem::path& path);

/// Whether the file can be opened and begins like an OpenEXR file.
bool is_exr_file(const std::filesystem::path& path);

struct ExrRgb {
    RgbImage image;
    bool half = false;  ///< a channel was stored as half
    Attributes attributes;
};

/// Reads R, G, B of a layer, or its single channel Y as grey. Throws InputError like read_exr(), and if neither exists.
ExrRgb read_exr_rgb(const std::filesystem::path& path, const std::string& layer = "");

/// Lossless compression of an EXR file. Noisy floats hardly shrink by any: `automatic` takes the fast one for them, and
/// ZIP if there are halves or integers.
enum class ExrCompression { automatic, none, rle, zips, zip, piz };

/// Compression of this name ("auto", "none", ...); empty if there is none.
std::optional<ExrCompression> find_compression(const std::string& name);

/// Storage format of an EXR file.
struct ExrStorage {
    std::vector<PixelType> types;  ///< one per channel, or one for all
    ExrCompression compression = ExrCompression::automatic;
    int tiles = 0;  ///< edge of its tiles, pixels; 0: scan lines
};

/// Lossless EXR file of all channels (half: values beyond +-65504 are clamped, not turned into infinities). An image
/// with a crop window becomes the data window inside the display window. Equal images give equal bytes. `path`: for
/// messages. Throws RunError.
std::vector<std::uint8_t> encode_exr(const std::filesystem::path& path, const Image& image,
                                     const Attributes& attributes, const ExrStorage& storage);
/// EXR file of scan lines, with all channels of one type.
std::vector<std::uint8_t> encode_exr(const std::filesystem::path& path, const Image& image,
                                     const Attributes& attributes = {}, PixelType type = PixelType::float32);

/// Writes the file of encode_exr() atomically. Throws RunError.
void write_exr(const std::filesystem::path& path, const Image& image, const Attributes& attributes = {},
               PixelType type = PixelType::float32);

}  // namespace treefarm
