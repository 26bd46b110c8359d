// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/image_target.h"
#include "tests/support/tiny_images.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    treefarm::fuzz::read_image(data, size);
    return 0;
}

namespace {

std::string png(int width, int height, int channels, int bits, double gamma) {
    treefarm::test::TinyPng image{width, height, channels, bits, {}, gamma};
    for (int i = 0; i < width * height * channels; ++i)
        image.values.push_back(static_cast<std::uint16_t>(i * 40503));
    return image.bytes();
}

/// A file with a palette, whose additions stand before its pixels.
std::string with_palette() {
    std::string file = png(7, 5, 1, 8, 0.0);
    file[25] = 3;  // the kind of pixels
    const std::size_t data = file.find("IDAT") - 4;
    const std::string palette = std::string("\0\0\0\x0c", 4) + "PLTE" + "\x01\x80\xff\x10\x20\x30 palette";
    const std::string transparency = std::string("\0\0\0\x02", 4) + "tRNS" + "\x01\x40 sum";
    return file.substr(0, data) + palette + transparency + file.substr(data);
}

}  // namespace

std::vector<std::string> treefarm::fuzz::seeds() {
    std::string huge = png(1, 1, 3, 8, 0.0);
    for (const std::size_t at : {18u, 19u, 22u, 23u})
        huge[at] = '\xff';  // 65535 x 65535
    return {png(3, 2, 1, 8, 0.0),
            png(2, 3, 2, 8, 2.2),
            png(3, 3, 3, 8, 0.45455),
            png(2, 2, 4, 16, 0.0),
            png(4, 1, 1, 16, 0.0),
            with_palette(),
            huge};
}
