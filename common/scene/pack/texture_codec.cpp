// SPDX-License-Identifier: Apache-2.0
#include "common/scene/pack/texture_codec.h"

#include "common/scene/pack/packed_fields.h"

namespace treefarm::packed {
void put_image(ByteWriter& out, const TextureImage& image) {
    out.put(static_cast<std::uint16_t>(image.width));
    out.put(static_cast<std::uint16_t>(image.height));
    out.put(static_cast<std::uint8_t>(image.channels));
    const bool floating = image.bytes.empty();
    put_flag(out, floating);
    if (floating) {
        out.put_array(std::span<const float>(image.floats));
    } else {
        for (const float value : image.decode)
            out.put(value);
        out.put_array(std::span<const std::uint8_t>(image.bytes));
    }
}

TextureImage get_image(ByteReader& in) {
    TextureImage image;
    image.width = in.get<std::uint16_t>();
    image.height = in.get<std::uint16_t>();
    image.channels = in.get<std::uint8_t>();
    if (image.width < 1 || image.height < 1 || (image.channels != 1 && image.channels != 3))
        throw FormatError("scene: an image of " + std::to_string(image.width) + " x " + std::to_string(image.height) +
                          " pixels and " + std::to_string(image.channels) + " channels");
    const std::uint64_t expected =
        std::uint64_t(image.width) * std::uint64_t(image.height) * std::uint64_t(image.channels);
    if (get_flag(in, "floating")) {
        image.floats = in.get_array<float>();
    } else {
        for (float& value : image.decode)
            value = in.get<float>();
        image.bytes = in.get_array<std::uint8_t>();
    }
    if (const std::size_t found = image.floats.size() + image.bytes.size(); found != expected)
        throw FormatError("scene: an image has " + std::to_string(found) + " values, not " + std::to_string(expected));
    return image;
}

void put_texture(ByteWriter& out, const Texture& texture) {
    out.put(static_cast<std::uint8_t>(texture.kind.index()));
    visit_fields(texture.kind, PutFields(out));
    out.put_string(texture.name);
}

Texture get_texture(ByteReader& in, std::size_t image_count) {
    Texture texture;
    texture.kind = kind_of<TextureKind>(in.get<std::uint8_t>(), "texture");
    visit_fields(texture.kind, GetFields(in, {.images = image_count}));
    texture.name = in.get_string();
    return texture;
}

}  // namespace treefarm::packed
