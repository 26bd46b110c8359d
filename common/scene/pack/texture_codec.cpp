// SPDX-License-Identifier: Apache-2.0
#include "common/scene/pack/texture_codec.h"

#include "common/scene/pack/packed_values.h"

namespace treefarm::packed {
namespace {

enum class TextureKind : std::uint8_t { bitmap, checkerboard };

void put_uv(ByteWriter& out, const UvTransform& uv) {
    put_vector(out, uv.u_row);
    put_vector(out, uv.v_row);
}

UvTransform get_uv(ByteReader& in) {
    UvTransform uv;
    uv.u_row = get_vector<Vec3>(in);
    uv.v_row = get_vector<Vec3>(in);
    return uv;
}

}  // namespace

void put_image(ByteWriter& out, const TextureImage& image) {
    out.put(static_cast<std::uint16_t>(image.width));
    out.put(static_cast<std::uint16_t>(image.height));
    out.put(static_cast<std::uint8_t>(image.channels));
    out.put_string(image.name);
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
    image.name = in.get_string();
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
    if (const auto* bitmap = std::get_if<BitmapTexture>(&texture.kind)) {
        put_enum(out, TextureKind::bitmap);
        out.put(bitmap->image);
        put_flag(out, bitmap->bilinear);
        put_enum(out, bitmap->wrap_u);
        put_enum(out, bitmap->wrap_v);
        put_uv(out, bitmap->uv);
    } else {
        const auto& board = std::get<CheckerboardTexture>(texture.kind);
        put_enum(out, TextureKind::checkerboard);
        put_vector(out, board.color0);
        put_vector(out, board.color1);
        put_uv(out, board.uv);
    }
    out.put_string(texture.name);
    put_location(out, texture.where);
}

Texture get_texture(ByteReader& in, std::size_t image_count) {
    Texture texture;
    switch (get_enum(in, TextureKind::checkerboard, "kind of texture")) {
        case TextureKind::bitmap: {
            BitmapTexture bitmap;
            bitmap.image = get_index(in, image_count, "image");
            bitmap.bilinear = get_flag(in, "bilinear");
            bitmap.wrap_u = get_enum(in, Wrap::one, "wrap mode");
            bitmap.wrap_v = get_enum(in, Wrap::one, "wrap mode");
            bitmap.uv = get_uv(in);
            texture.kind = bitmap;
            break;
        }
        case TextureKind::checkerboard: {
            CheckerboardTexture board;
            board.color0 = get_vector<Rgb>(in);
            board.color1 = get_vector<Rgb>(in);
            board.uv = get_uv(in);
            texture.kind = board;
            break;
        }
    }
    texture.name = in.get_string();
    texture.where = get_location(in);
    return texture;
}

}  // namespace treefarm::packed
