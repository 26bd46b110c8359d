// SPDX-License-Identifier: Apache-2.0
#include <ImathBox.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>
#include <ImfTiledOutputFile.h>
#include <half.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <deque>
#include <set>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/base/parallel.h"
#include "common/image/exr.h"

namespace treefarm {

namespace {

/// Output file in memory: OpenEXR's destructors swallow errors of a full disk, Treefarm's own writing does not.
class MemoryStream : public Imf::OStream {
  public:
    explicit MemoryStream(const char* name) : Imf::OStream(name) {}

    void write(const char bytes[], int count) override {
        const auto size = static_cast<std::size_t>(count);
        bytes_.resize(std::max(bytes_.size(), at_ + size));
        std::memcpy(bytes_.data() + at_, bytes, size);
        at_ += size;
    }
    std::uint64_t tellp() override { return at_; }
    void seekp(std::uint64_t position) override { at_ = static_cast<std::size_t>(position); }

    std::vector<std::uint8_t> take() { return std::move(bytes_); }

  private:
    std::vector<std::uint8_t> bytes_;
    std::size_t at_ = 0;
};

constexpr float kHalfMax = 65504.0f;

std::vector<half> to_half(std::span<const float> values) {
    std::vector<half> halves(values.size());
    std::transform(values.begin(), values.end(), halves.begin(),
                   [](float v) { return half(std::isfinite(v) ? std::clamp(v, -kHalfMax, kHalfMax) : v); });
    return halves;
}

std::vector<std::uint32_t> to_uint(std::span<const float> values) {
    std::vector<std::uint32_t> integers(values.size());
    std::transform(values.begin(), values.end(), integers.begin(), [](float v) {
        return v > 0.0f ? static_cast<std::uint32_t>(std::min(std::round(v), 0x1.fffffep31f)) : 0u;  // NaN: 0
    });
    return integers;
}

/// Data window of an image: its pixels at their position in the whole.
Imath::Box2i window_of(const Image& image) {
    return {{image.crop.x, image.crop.y}, {image.crop.x + image.width - 1, image.crop.y + image.height - 1}};
}

Imf::Header header_of(const Image& image) {
    if (!image.crop.is_window()) return {image.width, image.height};
    return {{{0, 0}, {image.crop.whole_width - 1, image.crop.whole_height - 1}}, window_of(image)};
}

void check(const std::filesystem::path& path, const Image& image) {
    if (image.width < 1 || image.height < 1 || image.channel_names.empty() ||
        image.data.size() != image.channel_names.size() * image.pixel_count())
        throw RunError(path.string() + ": an image of " + std::to_string(image.width) + " x " +
                       std::to_string(image.height) + " pixels, " + std::to_string(image.channel_names.size()) +
                       " channels and " + std::to_string(image.data.size()) + " values cannot be written");
}

void check_names(const std::filesystem::path& path, const Image& image) {
    std::set<std::string> seen;
    for (const std::string& name : image.channel_names)
        if (name.empty() || !seen.insert(name).second)
            throw RunError(path.string() + ": channel '" + name + "' has no name or occurs twice");
}

/// Number of threads of OpenEXR's pool, which all files share and which has none by default.
int compression_threads() {
    const auto threads = static_cast<int>(sweeping_threads());
    if (Imf::globalThreadCount() < threads) Imf::setGlobalThreadCount(threads);
    return threads;
}

Imf::PixelType stored_as(PixelType type) {
    return type == PixelType::half ? Imf::HALF : type == PixelType::uint32 ? Imf::UINT : Imf::FLOAT;
}

/// OpenEXR's name of a compression. `automatic` depends on the channels: noisy floats hardly shrink, with ZIP little
/// more than with RLE and in five times the time.
Imf::Compression packed_by(ExrCompression compression, const std::vector<PixelType>& types) {
    switch (compression) {
        case ExrCompression::none:
            return Imf::NO_COMPRESSION;
        case ExrCompression::rle:
            return Imf::RLE_COMPRESSION;
        case ExrCompression::zips:
            return Imf::ZIPS_COMPRESSION;
        case ExrCompression::zip:
            return Imf::ZIP_COMPRESSION;
        case ExrCompression::piz:
            return Imf::PIZ_COMPRESSION;
        case ExrCompression::automatic:
            break;
    }
    const bool all_floats =
        std::all_of(types.begin(), types.end(), [](PixelType type) { return type == PixelType::float32; });
    return all_floats ? Imf::RLE_COMPRESSION : Imf::ZIP_COMPRESSION;
}

/// Channels converted to the types of the file, in the layout that OpenEXR reads.
class StoredPixels {
  public:
    void insert(const Image& image, std::size_t c, PixelType type) {
        const std::span<const float> values = image.channel(c);
        if (type == PixelType::half)
            insert(image, c, halves_.emplace_back(to_half(values)).data());
        else if (type == PixelType::uint32)
            insert(image, c, integers_.emplace_back(to_uint(values)).data());
        else
            insert(image, c, values.data());
    }
    const Imf::FrameBuffer& buffer() const { return buffer_; }

  private:
    template <class T>
    void insert(const Image& image, std::size_t c, const T* values) {
        constexpr Imf::PixelType type = std::is_same_v<T, half>    ? Imf::HALF
                                        : std::is_same_v<T, float> ? Imf::FLOAT
                                                                   : Imf::UINT;
        // FrameBuffer serves reading and writing and takes no pointer to const; writing does not change the pixels.
        buffer_.insert(image.channel_names[c],
                       Imf::Slice::Make(type, const_cast<T*>(values), window_of(image), sizeof(T),
                                        sizeof(T) * static_cast<std::size_t>(image.width)));
    }

    std::deque<std::vector<half>> halves_;
    std::deque<std::vector<std::uint32_t>> integers_;
    Imf::FrameBuffer buffer_;
};

void write_pixels(Imf::OStream& stream, const Image& image, const Attributes& attributes, const ExrStorage& storage) {
    std::vector<PixelType> types = storage.types;
    if (types.size() == 1) types.assign(image.channel_names.size(), types[0]);
    if (types.size() != image.channel_names.size()) throw std::invalid_argument("as many types as channels are needed");
    Imf::Header header = header_of(image);
    header.compression() = packed_by(storage.compression, types);
    for (const auto& [name, text] : attributes)
        header.insert(name, Imf::StringAttribute(text));
    StoredPixels pixels;
    for (std::size_t c = 0; c < types.size(); ++c) {
        header.channels().insert(image.channel_names[c], Imf::Channel(stored_as(types[c])));
        pixels.insert(image, c, types[c]);
    }
    if (storage.tiles > 0) {
        const auto edge = static_cast<unsigned>(storage.tiles);
        header.setTileDescription(Imf::TileDescription(edge, edge, Imf::ONE_LEVEL));
        Imf::TiledOutputFile file(stream, header, compression_threads());
        file.setFrameBuffer(pixels.buffer());
        file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
        return;
    }
    Imf::OutputFile file(stream, header, compression_threads());
    file.setFrameBuffer(pixels.buffer());
    file.writePixels(image.height);
}

}  // namespace

std::optional<ExrCompression> find_compression(const std::string& name) {
    constexpr std::pair<const char*, ExrCompression> kNames[] = {
        {"auto", ExrCompression::automatic}, {"none", ExrCompression::none}, {"rle", ExrCompression::rle},
        {"zips", ExrCompression::zips},      {"zip", ExrCompression::zip},   {"piz", ExrCompression::piz}};
    for (const auto& [known, compression] : kNames)
        if (name == known) return compression;
    return std::nullopt;
}

std::vector<std::uint8_t> encode_exr(const std::filesystem::path& path, const Image& image,
                                     const Attributes& attributes, const ExrStorage& storage) {
    check(path, image);
    check_names(path, image);
    MemoryStream stream(path.c_str());
    try {
        write_pixels(stream, image, attributes, storage);
    } catch (const std::exception& error) {
        throw RunError(path.string() + ": cannot encode the image (" + error.what() + ")");
    }
    return stream.take();
}

std::vector<std::uint8_t> encode_exr(const std::filesystem::path& path, const Image& image,
                                     const Attributes& attributes, PixelType type) {
    return encode_exr(path, image, attributes, ExrStorage{{type}});
}

void write_exr(const std::filesystem::path& path, const Image& image, const Attributes& attributes, PixelType type) {
    write_output_file(path, encode_exr(path, image, attributes, type));
}

}  // namespace treefarm
