// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/images/stb.h"

#include <cstdlib>
#include <memory>

// The implementations are compiled in this file only, without the project's warnings.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
// Zeroed memory: parts that a damaged file leaves out (tables, pixels) are equal in every run.
#define STBI_MALLOC(size) std::calloc(1, size)
#define STBI_REALLOC(memory, size) std::realloc(memory, size)
#define STBI_FREE(memory) std::free(memory)
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_NO_STDIO
#define STBI_ONLY_BMP
#define STBI_ONLY_TGA
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

namespace treefarm::stb {

std::optional<Pixels> decode(std::span<const std::uint8_t> bytes, std::string& why) {
    Pixels pixels;
    const std::unique_ptr<stbi_uc, void (*)(void*)> values(
        stbi_load_from_memory(bytes.data(), static_cast<int>(bytes.size()), &pixels.width, &pixels.height,
                              &pixels.channels, 0),
        &stbi_image_free);
    if (!values) {
        const char* reason = stbi_failure_reason();
        why = reason != nullptr ? reason : "unknown reason";
        return std::nullopt;
    }
    pixels.bytes.assign(values.get(), values.get() + pixels.row_values() * static_cast<std::size_t>(pixels.height));
    return pixels;
}

}  // namespace treefarm::stb
