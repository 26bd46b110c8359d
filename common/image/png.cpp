// SPDX-License-Identifier: Apache-2.0
#include "common/image/png.h"

#include <algorithm>
#include <array>
#include <limits>

#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/image/png_encode.h"
#include "common/image/srgb.h"

namespace treefarm {

namespace {

/// Conversion from linear values in [0, 1] to 8-bit sRGB without a power per value. `first`: byte at the lower end of
/// each of many equal steps; `begin`: least value of each byte.
struct ByteTable {
    static constexpr std::size_t kSteps = 4096;
    std::array<std::uint8_t, kSteps + 1> first{};
    std::array<float, 257> begin{};

    ByteTable() {
        for (std::size_t byte = 1; byte < 256; ++byte)
            begin[byte] = srgb_decode((static_cast<float>(byte) - 0.5f) / 255.0f);
        begin[256] = std::numeric_limits<float>::infinity();
        std::size_t byte = 0;
        for (std::size_t step = 0; step <= kSteps; ++step) {
            while (begin[byte + 1] <= static_cast<float>(step) / kSteps)
                ++byte;
            first[step] = static_cast<std::uint8_t>(byte);
        }
    }

    std::uint8_t of(float linear) const {
        const float clamped = linear > 0.0f ? std::min(linear, 1.0f) : 0.0f;  // NaN fails the comparison
        std::size_t byte = first[static_cast<std::size_t>(clamped * kSteps)];
        while (begin[byte + 1] <= clamped)
            ++byte;
        return static_cast<std::uint8_t>(byte);
    }
};

}  // namespace

std::vector<std::uint8_t> encode_png(const RgbImage& image, float exposure, std::span<const float> alpha) {
    static const ByteTable table;
    const int channels = alpha.empty() ? 3 : 4;
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(channels) * image.pixels.size());
    std::uint8_t* next = bytes.data();
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        for (int c = 0; c < 3; ++c)
            *next++ = table.of(image.pixels[i][c] * exposure);
        if (channels == 4) {
            const float clamped = alpha[i] > 0.0f ? std::min(alpha[i], 1.0f) : 0.0f;  // NaN fails the comparison
            *next++ = static_cast<std::uint8_t>(clamped * 255.0f + 0.5f);
        }
    }
    std::vector<std::uint8_t> png = encode_png(image.width, image.height, channels, bytes);
    if (png.empty())
        throw RunError("an image of " + std::to_string(image.width) + " x " + std::to_string(image.height) +
                       " pixels cannot be encoded as PNG; make it smaller");
    return png;
}

void write_png(const std::filesystem::path& path, const RgbImage& image, float exposure) {
    write_output_file(path, encode_png(image, exposure));
}

}  // namespace treefarm
