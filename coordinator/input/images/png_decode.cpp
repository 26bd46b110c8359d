// SPDX-License-Identifier: Apache-2.0
#include <png.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "common/image/image.h"
#include "coordinator/input/images/decoders.h"

namespace treefarm {
namespace {

/// Decoder around libpng, which reports errors by a long jump that must not skip destructors: objects with destructors
/// live in decode_png(), and only run() is jumped out of.
class PngDecoder {
  public:
    PngDecoder(std::span<const std::uint8_t> bytes, std::string& why)
        : rest_(bytes),
          why_(why),
          png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, this, &PngDecoder::fail, &PngDecoder::ignore)),
          info_(png_ != nullptr ? png_create_info_struct(png_) : nullptr) {}
    ~PngDecoder() { png_destroy_read_struct(&png_, &info_, nullptr); }
    PngDecoder(const PngDecoder&) = delete;
    PngDecoder& operator=(const PngDecoder&) = delete;

    bool run(Pixels& pixels, std::vector<std::uint8_t>& wide) {
        if (info_ == nullptr) return false;
        if (setjmp(png_jmpbuf(png_)) != 0) return false;
        png_set_user_limits(png_, kMaxImageSide, kMaxImageSide);
        png_set_read_fn(png_, this, &PngDecoder::read);
        png_read_info(png_, info_);
        png_set_expand(png_);
        if (std::endian::native == std::endian::little) png_set_swap(png_);
        const int passes = png_set_interlace_handling(png_);
        png_read_update_info(png_, info_);
        pixels.width = static_cast<int>(png_get_image_width(png_, info_));
        pixels.height = static_cast<int>(png_get_image_height(png_, info_));
        pixels.channels = png_get_channels(png_, info_);
        const bool is_wide = png_get_bit_depth(png_, info_) == 16;
        const std::size_t row = png_get_rowbytes(png_, info_), height = static_cast<std::size_t>(pixels.height);
        std::vector<std::uint8_t>& target = is_wide ? wide : pixels.bytes;
        target.resize(row * height);
        for (int pass = 0; pass < passes; ++pass)
            for (std::size_t y = 0; y < height; ++y)
                png_read_row(png_, target.data() + y * row, nullptr);
        return true;
    }

  private:
    [[noreturn]] static void fail(png_structp png, png_const_charp message) {
        static_cast<PngDecoder*>(png_get_error_ptr(png))->why_ = message;
        png_longjmp(png, 1);
    }
    static void ignore(png_structp, png_const_charp) {}
    static void read(png_structp png, png_bytep to, std::size_t count) {
        auto& rest = static_cast<PngDecoder*>(png_get_io_ptr(png))->rest_;
        if (count > rest.size()) png_error(png, "it is cut short");
        std::memcpy(to, rest.data(), count);
        rest = rest.subspan(count);
    }

    std::span<const std::uint8_t> rest_;
    std::string& why_;
    png_structp png_;
    png_infop info_;
};

}  // namespace

std::optional<ImageSize> png_size(std::span<const std::uint8_t> bytes) {
    constexpr std::array<std::uint8_t, 8> kSignature = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    if (bytes.size() < 24 || !std::equal(kSignature.begin(), kSignature.end(), bytes.begin())) return std::nullopt;
    const auto word = [&](std::size_t at) {
        return std::uint32_t{bytes[at]} << 24 | std::uint32_t{bytes[at + 1]} << 16 | std::uint32_t{bytes[at + 2]} << 8 |
               bytes[at + 3];
    };
    constexpr std::uint32_t kLargest = 0x7fffffff;
    return ImageSize{static_cast<int>(std::min(word(16), kLargest)), static_cast<int>(std::min(word(20), kLargest))};
}

std::optional<Pixels> decode_png(std::span<const std::uint8_t> bytes, std::string& why) {
    Pixels pixels;
    std::vector<std::uint8_t> wide;
    if (!PngDecoder(bytes, why).run(pixels, wide)) {
        if (why.empty()) why = "out of memory";
        return std::nullopt;
    }
    pixels.floats.reserve(wide.size() / 2);
    for (std::size_t i = 0; i + 1 < wide.size(); i += 2) {
        std::uint16_t value = 0;
        std::memcpy(&value, &wide[i], 2);
        pixels.floats.push_back(static_cast<float>(value) / 65535.0f);
    }
    return pixels;
}

}  // namespace treefarm
