// SPDX-License-Identifier: Apache-2.0
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfStringAttribute.h>
#include <ImfTestFile.h>

#include <cstdint>
#include <new>

#include "common/base/error.h"
#include "common/image/exr.h"
#include "common/image/exr_header.h"

namespace treefarm {

namespace {

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& what, const std::string& cure) {
    throw InputError(Location{path.string()}, what, cure);
}

PixelType type_of(Imf::PixelType type) {
    if (type == Imf::HALF) return PixelType::half;
    return type == Imf::UINT ? PixelType::uint32 : PixelType::float32;
}

Attributes string_attributes(const Imf::Header& header) {
    Attributes attributes;
    for (auto it = header.begin(); it != header.end(); ++it)
        if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&it.attribute()))
            attributes[it.name()] = text->value();
    return attributes;
}

void check_is_exr(const std::filesystem::path& path) {
    std::error_code none;
    const auto status = std::filesystem::status(path, none);
    if (!std::filesystem::exists(status)) refuse(path, "no such file", "check the path");
    if (!std::filesystem::is_regular_file(status)) refuse(path, "not a regular file", "give the path of an EXR file");
    bool tiled = false, deep = false, multi_part = false;
    if (!Imf::isOpenExrFile(path.c_str(), tiled, deep, multi_part))
        refuse(path, "not an OpenEXR file (its first bytes differ, or it cannot be read)", "give an .exr file");
    if (deep) refuse(path, "holds deep pixels, which are not read", "flatten it first");
}

void check_size(const std::filesystem::path& path, const Imath::Box2i& window, std::size_t channels,
                std::uint64_t most_pixels) {
    const auto width = static_cast<std::size_t>(std::int64_t{window.max.x} - window.min.x + 1);
    const auto height = static_cast<std::size_t>(std::int64_t{window.max.y} - window.min.y + 1);
    if (width * height > most_pixels)
        refuse(path,
               "claims " + std::to_string(width) + " x " + std::to_string(height) + " pixels, more than the " +
                   std::to_string(most_pixels) + " that are allowed",
               "reduce its size, or check whether it is damaged");
    if (width * height > kMaxImageValues / channels)
        refuse(path,
               "claims " + std::to_string(width) + " x " + std::to_string(height) + " pixels in " +
                   std::to_string(channels) + " channels, more than the " + std::to_string(kMaxImageValues) +
                   " values that are read",
               "crop it, or check whether the file is damaged");
}

/// Names and types of the channels to read, in the file's (alphabetical) order.
void select_channels(const std::filesystem::path& path, const Imf::ChannelList& channels,
                     const std::function<bool(const std::string&)>& wanted, ExrImage& result) {
    for (auto it = channels.begin(); it != channels.end(); ++it) {
        if (wanted && !wanted(it.name())) continue;
        if (it.channel().xSampling != 1 || it.channel().ySampling != 1)
            refuse(path, "channel '" + std::string(it.name()) + "' is subsampled, which is not read",
                   "save it with one value per pixel");
        result.image.channel_names.emplace_back(it.name());
        result.types.push_back(type_of(it.channel().type));
    }
    if (result.image.channel_names.empty())
        refuse(path, "holds none of the wanted channels", "check which channels it has (exrheader)");
}

/// Position of a data window inside the display window; none if it fills that window or extends beyond.
CropWindow crop_of(const Imath::Box2i& data, const Imath::Box2i& display) {
    if (data == display || !display.intersects(data.min) || !display.intersects(data.max)) return {};
    const auto span = [](int low, int high) { return std::int64_t{high} - low; };
    if (span(display.min.x, display.max.x) >= kMaxImageSide || span(display.min.y, display.max.y) >= kMaxImageSide)
        return {};
    return {data.min.x - display.min.x, data.min.y - display.min.y, display.max.x - display.min.x + 1,
            display.max.y - display.min.y + 1};
}

ExrImage read_checked(const std::filesystem::path& path, const std::function<bool(const std::string&)>& wanted,
                      std::uint64_t most_pixels) {
    Imf::InputFile file(path.c_str());
    const Imf::Header& header = file.header();
    const Imath::Box2i window = header.dataWindow();

    ExrImage result;
    select_channels(path, header.channels(), wanted, result);
    check_size(path, window, result.image.channel_names.size(), most_pixels);
    if (!file.isComplete()) refuse(path, "is cut short: parts of the image are missing", "write or copy it again");
    result.attributes = string_attributes(header);

    Image& image = result.image;
    image.width = window.max.x - window.min.x + 1;
    image.height = window.max.y - window.min.y + 1;
    image.crop = crop_of(window, header.displayWindow());
    image.data.resize(image.channel_names.size() * image.pixel_count());
    Imf::FrameBuffer buffer;
    for (std::size_t c = 0; c < image.channel_names.size(); ++c)
        buffer.insert(image.channel_names[c],
                      Imf::Slice::Make(Imf::FLOAT, image.channel(c).data(), window, sizeof(float),
                                       sizeof(float) * static_cast<std::size_t>(image.width)));
    file.setFrameBuffer(buffer);
    file.readPixels(window.min.y, window.max.y);
    return result;
}

/// The result of `read`; exceptions of OpenEXR become InputError.
template <class Read>
auto guarded(const std::filesystem::path& path, Read read) {
    // OpenEXR has these limits per process; they are always equal, and are checked before it allocates by the header.
    Imf::Header::setMaxImageSize(kMaxImageSide, kMaxImageSide);
    Imf::Header::setMaxTileSize(kMaxImageSide, kMaxImageSide);
    try {
        return read();
    } catch (const InputError&) {
        throw;
    } catch (const std::bad_alloc&) {
        refuse(path, "does not fit into the memory", "crop it, or check whether the file is damaged");
    } catch (const std::exception& error) {
        refuse(path, std::string("cannot be read (") + error.what() + ")",
               "it is damaged, cut short or larger than " + std::to_string(kMaxImageSide) + " pixels on a side");
    }
}

}  // namespace

bool is_exr_file(const std::filesystem::path& path) {
    std::error_code none;
    return std::filesystem::is_regular_file(path, none) && Imf::isOpenExrFile(path.c_str());
}

ExrImage read_exr(const std::filesystem::path& path, const std::function<bool(const std::string&)>& wanted,
                  std::uint64_t most_pixels) {
    check_is_exr(path);
    check_exr_header(path);
    return guarded(path, [&] { return read_checked(path, wanted, most_pixels); });
}

std::vector<std::string> exr_channel_names(const std::filesystem::path& path) {
    check_is_exr(path);
    check_exr_header(path);
    return guarded(path, [&] {
        std::vector<std::string> names;
        const Imf::InputFile file(path.c_str());
        for (auto it = file.header().channels().begin(); it != file.header().channels().end(); ++it)
            names.emplace_back(it.name());
        return names;
    });
}

ExrRgb read_exr_rgb(const std::filesystem::path& path, const std::string& layer) {
    const std::string r = channel_name(layer, "R"), g = channel_name(layer, "G"), b = channel_name(layer, "B"),
                      y = channel_name(layer, "Y");
    ExrImage file =
        read_exr(path, [&](const std::string& name) { return name == r || name == g || name == b || name == y; });
    auto rgb = rgb_layer(file.image, layer);
    if (!rgb)
        refuse(path, "has neither the channels " + r + ", " + g + ", " + b + " nor " + y,
               "check which channels it has (exrheader)");
    ExrRgb result{std::move(*rgb), false, std::move(file.attributes)};
    for (const PixelType type : file.types)
        result.half = result.half || type == PixelType::half;
    return result;
}

}  // namespace treefarm
