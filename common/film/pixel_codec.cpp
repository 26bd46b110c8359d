// SPDX-License-Identifier: Apache-2.0
#include "common/film/pixel_codec.h"

#include <array>
#include <cstring>

namespace treefarm {

/// Writes a pixel in one piece, since there are millions.
void put_estimate(ByteWriter& writer, const PixelEstimate& pixel) {
    std::array<std::uint8_t, kEstimateBytes> bytes;
    std::uint8_t* next = bytes.data();
    const auto add = [&](const auto& value) {
        std::memcpy(next, &value, sizeof value);
        next += sizeof value;
    };
    for (const Moments& half : pixel.half) {
        add(half.n);
        for (const Rgb64& sum : {half.mean, half.m2})
            add(std::array{sum.x, sum.y, sum.z});
    }
    writer.put_bytes(bytes);
}

PixelEstimate get_estimate(ByteReader& reader) {
    PixelEstimate pixel;
    for (Moments& half : pixel.half) {
        half.n = reader.get<std::uint32_t>();
        for (Rgb64* sum : {&half.mean, &half.m2})
            for (double* value : {&sum->x, &sum->y, &sum->z})
                *value = reader.get<double>();
    }
    return pixel;
}

}  // namespace treefarm
