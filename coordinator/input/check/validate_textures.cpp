// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "coordinator/input/check/validation.h"

namespace treefarm::validation {
namespace {

ValueRange check_values(const float* begin, const float* end, const Location& where) {
    for (const float* value = begin; value != end; ++value)
        if (!std::isfinite(*value))
            throw InputError(where, "the image has a value that is not finite", "repair the image");
    const auto [min, max] = std::minmax_element(begin, end);
    return {*min, *max};
}

/// Range of the values of the bytes that occur.
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

class TextureCheck {
  public:
    TextureCheck(const Scene& scene, const Texture& texture, const std::vector<ValueRange>& images)
        : scene_(scene), texture_(texture), images_(images) {}

    /// Range of the texture's values.
    ValueRange run() const {
        visit_fields(texture_.kind, *this);
        return std::visit([this](const auto& kind) { return kind.range(*this); }, texture_.kind);
    }
    ValueRange range_of_image(std::int32_t image) const { return images_[static_cast<std::size_t>(image)]; }
    ValueRange range_of_attribute(const std::string& name) const { return scene_.range_of_attribute(name); }

    void image(std::int32_t image) const {
        if (image < 0 || static_cast<std::size_t>(image) >= images_.size())
            refuse("the texture has no image", "give it a file");
    }
    void flag(const char*, bool) const {}
    void choice(const char*, auto, auto) const {}
    void mesh_attribute(const std::string&) const {}  // checked for each shape
    void color(const char* name, const Rgb& value) const {
        if (!is_finite(value))
            refuse("the " + title() + " has a " + name + " that is not finite",
                   std::string("give finite ") + name + "s");
    }
    void extent(const char* name, float value) const {
        if (!(value >= 0.0f) || !std::isfinite(value))
            refuse("the " + title() + " has a " + name + " that is negative or not finite", "give 0 or more");
    }
    void coordinates(const UvTransform& uv) const {
        if (!is_finite(uv.u_row) || !is_finite(uv.v_row))
            refuse("the transformation of texture coordinates is not finite", "check the texture's scale and offset");
    }

  private:
    std::string title() const {
        return std::visit([](const auto& kind) { return kind.kEffect.title; }, texture_.kind);
    }
    [[noreturn]] void refuse(const std::string& what, const std::string& cure) const {
        throw InputError(texture_.where, what, cure);
    }

    const Scene& scene_;
    const Texture& texture_;
    const std::vector<ValueRange>& images_;
};

}  // namespace

std::vector<ValueRange> check_images(const std::vector<TextureImage>& images) {
    std::vector<ValueRange> ranges;
    ranges.reserve(images.size());
    for (const TextureImage& image : images)
        ranges.push_back(check_image(image));
    return ranges;
}

std::vector<ValueRange> check_textures(const Scene& scene, const std::vector<ValueRange>& images) {
    std::vector<ValueRange> ranges;
    for (const Texture& texture : scene.textures)
        ranges.push_back(TextureCheck(scene, texture, images).run());
    return ranges;
}

}  // namespace treefarm::validation
