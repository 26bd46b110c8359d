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

/// How an EXR file stores a channel. Everything is read as float; integers above 2^24 round.
enum class PixelType { half, float32, uint32 };

/// Text attributes of the header: "treefarm.spp" -> "64".
using Attributes = std::map<std::string, std::string>;

struct ExrImage {
    Image image;
    std::vector<PixelType> types;  ///< one per channel of `image`: halves carry a rounding error
    Attributes attributes;         ///< of type string
};

/// Reads the channels for which `wanted` holds (none given: all) over the file's data window; its place is known
/// where it is a part of the display window. Scan lines or tiles, any compression; of a multi-part file the first part.
/// Throws InputError that names the file: missing, not EXR, damaged, cut short, too large (by `most_pixels`, too,
/// before anything is allocated for them), subsampled, no such channel.
ExrImage read_exr(const std::filesystem::path& path, const std::function<bool(const std::string&)>& wanted = {},
                  std::uint64_t most_pixels = ~0ull);

/// The names of a file's channels, in its (alphabetical) order. Throws InputError like read_exr.
std::vector<std::string> exr_channel_names(const std::filesystem::path& path);

/// The file can be opened and begins like an OpenEXR file.
bool is_exr_file(const std::filesystem::path& path);

struct ExrRgb {
    RgbImage image;
    bool half = false;  ///< a channel was stored as half
    Attributes attributes;
};

/// Reads R, G, B of a layer, or its single channel Y as grey. Throws InputError like read_exr, and where neither
/// exists.
ExrRgb read_exr_rgb(const std::filesystem::path& path, const std::string& layer = "");

/// How an EXR file is packed, without loss. Of noisy floats nothing saves much: automatic takes the fast one, ZIP where
/// there are halves or integers.
enum class ExrCompression { automatic, none, rle, zips, zip, piz };

/// The compression of that name ("auto", "none", ...), if there is one.
std::optional<ExrCompression> find_compression(const std::string& name);

/// The form of an EXR file.
struct ExrStorage {
    std::vector<PixelType> types;  ///< one per channel, or one for all
    ExrCompression compression = ExrCompression::automatic;
    int tiles = 0;  ///< edge of its tiles, pixels; 0: scan lines
};

/// An EXR file of all channels (half: values beyond +-65504 are clamped, not turned into infinities), lossless. A
/// placed image is the data window inside the display window. The same image gives the same bytes. `path` is for
/// messages. Throws RunError.
std::vector<std::uint8_t> encode_exr(const std::filesystem::path& path, const Image& image,
                                     const Attributes& attributes, const ExrStorage& storage);
/// A file of scan lines, with all channels of one type.
std::vector<std::uint8_t> encode_exr(const std::filesystem::path& path, const Image& image,
                                     const Attributes& attributes = {}, PixelType type = PixelType::float32);

/// Writes what encode_exr() gives, atomically. Throws RunError.
void write_exr(const std::filesystem::path& path, const Image& image, const Attributes& attributes = {},
               PixelType type = PixelType::float32);

}  // namespace treefarm
