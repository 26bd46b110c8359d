// SPDX-License-Identifier: Apache-2.0
#include "common/scene/uses/texture_mean.h"

namespace treefarm {
namespace {

Rgb image_mean(const TextureImage& image) {
    double sum[3] = {0, 0, 0};
    const std::size_t count = image.bytes.empty() ? image.floats.size() : image.bytes.size();
    const auto channels = static_cast<std::size_t>(image.channels);
    for (std::size_t i = 0; i < count; ++i)
        sum[i % channels] += double(image.bytes.empty() ? image.floats[i] : image.decode[image.bytes[i]]);
    Rgb mean(0.0f);
    for (std::size_t c = 0; c < 3 && count > 0; ++c)
        mean[static_cast<int>(c)] =
            static_cast<float>(sum[channels == 1 ? 0 : c] * static_cast<double>(channels) / static_cast<double>(count));
    return mean;
}

struct Means {
    const Scene& scene;
    Rgb mean_of_image(std::int32_t image) const { return image_mean(scene.images[static_cast<std::size_t>(image)]); }
    Rgb mean_of_attribute(const std::string& name) const { return scene.mean_of_attribute(name); }
};

}  // namespace

Rgb texture_mean(const Scene& scene, std::int32_t texture) {
    return std::visit([&](const auto& kind) { return kind.mean(Means{scene}); },
                      scene.textures[static_cast<std::size_t>(texture)].kind);
}

std::size_t image_bytes(const TextureImage& image) {
    const std::size_t table = image.bytes.empty() ? 0 : sizeof image.decode;
    return image.bytes.size() + image.floats.size() * sizeof(float) + table;
}

}  // namespace treefarm
