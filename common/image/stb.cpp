// SPDX-License-Identifier: Apache-2.0
#include "common/image/stb.h"

#include <cstdlib>
#include <memory>
#include <type_traits>

// The implementations live in this file alone and are held to their own standard of warnings, not ours.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
// Zeroed memory: what a damaged file leaves out (tables, parts of the image) is the same on every run.
#define STBI_MALLOC(size) std::calloc(1, size)
#define STBI_REALLOC(memory, size) std::realloc(memory, size)
#define STBI_FREE(memory) std::free(memory)
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_NO_STDIO
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_ONLY_BMP
#define STBI_ONLY_TGA
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

namespace treefarm::stb {

std::optional<Size> image_size(std::span<const std::uint8_t> bytes) {
    Size size;
    int channels = 0;
    if (!stbi_info_from_memory(bytes.data(), static_cast<int>(bytes.size()), &size.width, &size.height, &channels))
        return std::nullopt;
    return size;
}

std::optional<Decoded> decode(std::span<const std::uint8_t> bytes, std::string& why) {
    Decoded result;
    const std::unique_ptr<stbi_us, void (*)(void*)> values(
        stbi_load_16_from_memory(bytes.data(), static_cast<int>(bytes.size()), &result.width, &result.height,
                                 &result.channels, 0),
        &stbi_image_free);
    if (!values) {
        const char* reason = stbi_failure_reason();
        why = reason != nullptr ? reason : "unknown reason";
        return std::nullopt;
    }
    const std::size_t count = static_cast<std::size_t>(result.width) * static_cast<std::size_t>(result.height) *
                              static_cast<std::size_t>(result.channels);
    result.values.assign(values.get(), values.get() + count);
    return result;
}

std::optional<Stored> decode_as_stored(std::span<const std::uint8_t> bytes, std::string& why) {
    Stored result;
    const auto size = static_cast<int>(bytes.size());
    const auto take = [&](auto* pixels, auto convert) {
        using Pixel = std::remove_pointer_t<decltype(pixels)>;
        const std::unique_ptr<Pixel, void (*)(void*)> values(pixels, &stbi_image_free);
        if (!values) {
            const char* reason = stbi_failure_reason();
            why = reason != nullptr ? reason : "unknown reason";
            return false;
        }
        const std::size_t count = static_cast<std::size_t>(result.width) * static_cast<std::size_t>(result.height) *
                                  static_cast<std::size_t>(result.channels);
        convert(values.get(), values.get() + count);
        return true;
    };
    const auto copy_bytes = [&](const stbi_uc* begin, const stbi_uc* end) { result.bytes.assign(begin, end); };
    const auto scale_words = [&](const stbi_us* begin, const stbi_us* end) {
        result.floats.reserve(static_cast<std::size_t>(end - begin));
        for (const stbi_us* p = begin; p != end; ++p)
            result.floats.push_back(static_cast<float>(*p) / 65535.0f);
    };
    int *w = &result.width, *h = &result.height, *n = &result.channels;
    bool done = false;
    if (stbi_is_16_bit_from_memory(bytes.data(), size) != 0) {
        done = take(stbi_load_16_from_memory(bytes.data(), size, w, h, n, 0), scale_words);
    } else {
        done = take(stbi_load_from_memory(bytes.data(), size, w, h, n, 0), copy_bytes);
    }
    if (!done) return std::nullopt;
    return result;
}

}  // namespace treefarm::stb
