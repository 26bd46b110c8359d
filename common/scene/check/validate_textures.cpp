// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "common/scene/check/validation.h"

namespace treefarm::validation {
namespace {

ValueRange check_values(const float* begin, const float* end, const Location& where) {
    for (const float* value = begin; value != end; ++value)
        if (!std::isfinite(*value))
            throw InputError(where, "the image has a value that is not finite", "repair the image");
    const auto [min, max] = std::minmax_element(begin, end);
    return {*min, *max};
}

/// The range of the bytes that occur.
ValueRange range_of_bytes(const TextureImage& image) {
    std::array<bool, 256> occurs{};
    for (const std::uint8_t byte : image.bytes)
        occurs[byte] = true;
    ValueRange range{image.decode[image.bytes[0]], image.decode[image.bytes[0]]};
    for (std::size_t byte = 0; byte < 256; ++byte)
        if (occurs[byte]) range = {std::min(range.min, image.decode[byte]), std::max(range.max, image.decode[byte])};
    return range;
}

ValueRange check_image(const TextureImage& image) {
    const Location where{image.name};
    if (image.width < 1 || image.height < 1 || image.width > 65535 || image.height > 65535)
        throw InputError(
            where, "the image has " + std::to_string(image.width) + " x " + std::to_string(image.height) + " pixels",
            "images may have 1 to 65535 pixels a side");
    if (image.channels != 1 && image.channels != 3)
        throw InputError(where, "the image has " + std::to_string(image.channels) + " channels", "give it 1 or 3");
    const std::size_t count = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) *
                              static_cast<std::size_t>(image.channels);
    if (image.bytes.empty() ? image.floats.size() != count : image.bytes.size() != count || !image.floats.empty())
        throw InputError(where, "the image has not as many values as its size says", "repair the image");
    if (image.bytes.empty()) return check_values(image.floats.data(), image.floats.data() + count, where);
    check_values(image.decode.data(), image.decode.data() + image.decode.size(), where);
    return range_of_bytes(image);
}

ValueRange check_bitmap(const BitmapTexture& bitmap, const std::vector<ValueRange>& images, const Location& where) {
    if (bitmap.image < 0 || static_cast<std::size_t>(bitmap.image) >= images.size())
        throw InputError(where, "the texture has no image", "give it a file");
    ValueRange range = images[static_cast<std::size_t>(bitmap.image)];
    for (const Wrap wrap : {bitmap.wrap_u, bitmap.wrap_v}) {
        if (wrap == Wrap::zero) range = {std::min(range.min, 0.0f), std::max(range.max, 0.0f)};
        if (wrap == Wrap::one) range = {std::min(range.min, 1.0f), std::max(range.max, 1.0f)};
    }
    return range;
}

ValueRange check_checkerboard(const CheckerboardTexture& board, const Location& where) {
    const float values[6] = {board.color0.x, board.color0.y, board.color0.z,
                             board.color1.x, board.color1.y, board.color1.z};
    for (const float value : values)
        if (!std::isfinite(value))
            throw InputError(where, "the checkerboard has a colour that is not finite", "give finite colours");
    const auto [min, max] = std::minmax_element(std::begin(values), std::end(values));
    return {*min, *max};
}

}  // namespace

std::vector<ValueRange> check_images(const std::vector<TextureImage>& images) {
    std::vector<ValueRange> ranges;
    for (const TextureImage& image : images)
        ranges.push_back(check_image(image));
    return ranges;
}

std::vector<ValueRange> check_textures(const std::vector<Texture>& textures, const std::vector<ValueRange>& images) {
    std::vector<ValueRange> ranges;
    for (const Texture& texture : textures) {
        const auto* bitmap = std::get_if<BitmapTexture>(&texture.kind);
        const UvTransform& uv = bitmap ? bitmap->uv : std::get<CheckerboardTexture>(texture.kind).uv;
        if (!is_finite(uv.u_row) || !is_finite(uv.v_row))
            throw InputError(texture.where, "the transformation of texture coordinates is not finite",
                             "check the texture's scale and offset");
        ranges.push_back(bitmap ? check_bitmap(*bitmap, images, texture.where)
                                : check_checkerboard(std::get<CheckerboardTexture>(texture.kind), texture.where));
    }
    return ranges;
}

}  // namespace treefarm::validation
