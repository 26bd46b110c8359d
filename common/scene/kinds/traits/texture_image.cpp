// SPDX-License-Identifier: Apache-2.0
#include "common/scene/kinds/traits/texture_image.h"

namespace treefarm {

float mean_value(const TextureImage& image) {
    double sum = 0;
    for (const std::uint8_t byte : image.bytes)
        sum += double(image.decode[byte]);
    for (const float value : image.floats)
        sum += double(value);
    const std::size_t count = image.bytes.size() + image.floats.size();
    return count > 0 ? static_cast<float>(sum / static_cast<double>(count)) : 0.0f;
}

}  // namespace treefarm
