// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/image_target.h"

#include <cstdlib>

#include "common/base/error.h"
#include "common/image/exr.h"
#include "common/image/png.h"
#include "coordinator/input/images/stored_image.h"
#include "tests/fuzz/memory_file.h"

namespace treefarm::fuzz {

void read_image(const std::uint8_t* data, std::size_t size) {
    const MemoryFile file(data, size);
    try {
        const StoredImage image = read_stored_image(file.path());
        const std::size_t values =
            static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * image.channels.size();
        if (image.width < 1 || image.height < 1 || image.bytes.size() + image.floats.size() != values ||
            (!image.bytes.empty() && !image.floats.empty()) || !(image.gamma >= 0.0))
            std::abort();
    } catch (const InputError&) {
    }
    try {
        const Image image =
            is_exr_file(file.path()) ? read_exr(file.path()).image : read_ldr(file.path(), Encoding::srgb);
        if (image.data.size() != image.pixel_count() * image.channel_names.size()) std::abort();
    } catch (const InputError&) {
    }
}

}  // namespace treefarm::fuzz
