// SPDX-License-Identifier: Apache-2.0
#include <csetjmp>
#include <cstdio>  // jpeglib.h does not include it

#include "coordinator/input/images/decoders.h"
//
#include <jerror.h>
#include <jpeglib.h>

namespace treefarm {
namespace {

/// Decoder around libjpeg, which reports errors by a long jump that must not skip destructors: objects with destructors
/// live outside of the functions that are jumped out of.
class JpegDecoder {
  public:
    JpegDecoder(std::span<const std::uint8_t> bytes, std::string& why) : bytes_(bytes), why_(why) {
        info_.err = jpeg_std_error(&errors_);
        info_.client_data = this;
        errors_.error_exit = &JpegDecoder::fail;
        errors_.emit_message = &JpegDecoder::hear;
        errors_.output_message = [](j_common_ptr) {};
        progress_.progress_monitor = &JpegDecoder::watch;
    }
    ~JpegDecoder() { jpeg_destroy_decompress(&info_); }
    JpegDecoder(const JpegDecoder&) = delete;
    JpegDecoder& operator=(const JpegDecoder&) = delete;

    bool read_size(ImageSize& size) {
        if (setjmp(jump_) != 0) return false;
        read_header();
        size = {static_cast<int>(info_.image_width), static_cast<int>(info_.image_height)};
        return true;
    }

    bool run(Pixels& pixels) {
        if (setjmp(jump_) != 0) return false;
        read_header();
        const bool has_inks = info_.jpeg_color_space == JCS_CMYK || info_.jpeg_color_space == JCS_YCCK;
        const bool is_grey = info_.jpeg_color_space == JCS_GRAYSCALE;
        info_.out_color_space = has_inks ? JCS_CMYK : is_grey ? JCS_GRAYSCALE : JCS_RGB;
        jpeg_start_decompress(&info_);
        pixels.width = static_cast<int>(info_.output_width);
        pixels.height = static_cast<int>(info_.output_height);
        pixels.channels = info_.output_components;
        pixels.bytes.resize(pixels.row_values() * info_.output_height);
        while (info_.output_scanline < info_.output_height) {
            JSAMPROW row = pixels.bytes.data() + pixels.row_values() * info_.output_scanline;
            jpeg_read_scanlines(&info_, &row, 1);
        }
        jpeg_finish_decompress(&info_);
        if (has_inks) mix_inks(pixels, info_.saw_Adobe_marker != FALSE);
        return true;
    }

  private:
    void read_header() {
        jpeg_create_decompress(&info_);
        info_.progress = &progress_;
        jpeg_mem_src(&info_, bytes_.data(), static_cast<unsigned long>(bytes_.size()));
        jpeg_read_header(&info_, TRUE);
    }

    /// Converts cyan, magenta, yellow and black to the remaining white. Adobe's programs store inverted inks.
    static void mix_inks(Pixels& pixels, bool inverted) {
        std::uint8_t* to = pixels.bytes.data();
        for (std::size_t i = 0; i + 3 < pixels.bytes.size(); i += 4) {
            const auto left = [&](std::size_t at) {
                const int value = pixels.bytes[i + at];
                return inverted ? value : 255 - value;
            };
            const int r = left(0), g = left(1), b = left(2), k = left(3);
            *to++ = static_cast<std::uint8_t>((r * k + 127) / 255);
            *to++ = static_cast<std::uint8_t>((g * k + 127) / 255);
            *to++ = static_cast<std::uint8_t>((b * k + 127) / 255);
        }
        pixels.channels = 3;
        pixels.bytes.resize(static_cast<std::size_t>(to - pixels.bytes.data()));
    }

    [[noreturn]] static void fail(j_common_ptr info) {
        auto* self = static_cast<JpegDecoder*>(info->client_data);
        char message[JMSG_LENGTH_MAX];
        info->err->format_message(info, message);
        self->why_ = message;
        std::longjmp(self->jump_, 1);
    }
    /// Turns a warning into an error: libjpeg would continue with grey or garbage.
    static void hear(j_common_ptr info, int level) {
        const int what = info->err->msg_code;
        const bool harmless = what == JWRN_EXTRANEOUS_DATA || what == JWRN_TOO_MUCH_DATA || what == JWRN_ADOBE_XFORM;
        if (level < 0 && !harmless) fail(info);
    }
    /// Limits the number of scans, since a few bytes can ask for one more scan over all pixels.
    static void watch(j_common_ptr info) {
        constexpr int kMostScans = 500;
        auto* self = static_cast<JpegDecoder*>(info->client_data);
        if (self->info_.input_scan_number <= kMostScans) return;
        self->why_ = "it has more than 500 scans";
        std::longjmp(self->jump_, 1);
    }

    std::span<const std::uint8_t> bytes_;
    std::string& why_;
    jpeg_decompress_struct info_{};
    jpeg_error_mgr errors_{};
    jpeg_progress_mgr progress_{};
    std::jmp_buf jump_{};
};

}  // namespace

std::optional<ImageSize> jpeg_size(std::span<const std::uint8_t> bytes, std::string& why) {
    ImageSize size;
    if (!JpegDecoder(bytes, why).read_size(size)) return std::nullopt;
    return size;
}

std::optional<Pixels> decode_jpeg(std::span<const std::uint8_t> bytes, std::string& why) {
    Pixels pixels;
    if (!JpegDecoder(bytes, why).run(pixels)) return std::nullopt;
    return pixels;
}

}  // namespace treefarm
