// SPDX-License-Identifier: Apache-2.0
#include "cli/picture_of_layer.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "common/base/error.h"
#include "common/image/srgb.h"

namespace treefarm {

namespace {

std::string layer_of(const std::string& channel) {
    const std::size_t dot = channel.rfind('.');
    return dot == std::string::npos ? "" : channel.substr(0, dot);
}

/// Linear value that the sRGB curve maps to `shown`, for values that are not light.
float plain(float shown) {
    return srgb_decode(shown > 0.0f ? std::min(shown, 1.0f) : 0.0f);
}

/// Range of the finite values; zero is kept apart if there are other values.
struct Range {
    float low = 0, high = 0;

    explicit Range(std::span<const float> values) {
        bool any = false;
        for (const float v : values) {
            if (!std::isfinite(v) || v == 0.0f) continue;
            low = any ? std::min(low, v) : v;
            high = any ? std::max(high, v) : v;
            any = true;
        }
    }
    /// The value scaled to 0.1 to 1, so that the least is not black.
    float normalised(float v) const {
        if (v == 0.0f || std::isnan(v)) return 0.0f;
        return high > low ? 0.1f + 0.9f * (v - low) / (high - low) : 1.0f;
    }
};

std::string range_text(const std::string& channel, const Range& range) {
    char text[64];
    std::snprintf(text, sizeof text, ": %.6g is dark, %.6g white", static_cast<double>(range.low),
                  static_cast<double>(range.high));
    return channel + text;
}

/// A distinct colour for each number.
Rgb colour_of(float number) {
    if (!(number > 0.0f)) return Rgb(0.0f);
    const float hue = number * 0.6180339887f - std::floor(number * 0.6180339887f);  // far from those of neighbours
    const auto component = [hue](float shift) {
        const float position = hue + shift - std::floor(hue + shift);
        return plain(0.25f + 0.75f * std::clamp(std::abs(6.0f * position - 3.0f) - 1.0f, 0.0f, 1.0f));
    };
    return {component(0.0f), component(2.0f / 3.0f), component(1.0f / 3.0f)};
}

}  // namespace

std::vector<std::string> layer_names(const Image& image) {
    std::vector<std::string> names;
    for (const std::string& channel : image.channel_names)
        if (const std::string layer = layer_of(channel); std::find(names.begin(), names.end(), layer) == names.end())
            names.push_back(layer);
    std::sort(names.begin(), names.end());
    return names;
}

ImageLayer find_image_layer(const Image& image, const std::string& layer, const std::string& file) {
    constexpr std::pair<const char*, ImageLayer::Kind> kForms[] = {
        {"RGB", ImageLayer::Kind::colour}, {"XYZ", ImageLayer::Kind::vector}, {"UV", ImageLayer::Kind::uv},
        {"I", ImageLayer::Kind::numbers},  {"Y", ImageLayer::Kind::single},   {"Z", ImageLayer::Kind::single},
        {"A", ImageLayer::Kind::single}};
    for (const auto& [components, kind] : kForms) {
        ImageLayer found{kind, {}};
        for (const char* c = components; *c != 0; ++c)
            if (const auto at = image.find(channel_name(layer, std::string(1, *c)))) found.channels.push_back(*at);
        if (found.channels.size() == std::char_traits<char>::length(components)) return found;
    }
    if (layer == "alpha")
        if (const auto alpha = image.find("A")) return {ImageLayer::Kind::single, {*alpha}};
    if (const auto whole = image.find(layer)) return {ImageLayer::Kind::single, {*whole}};  // full name of a channel
    std::string list;
    for (const std::string& name : layer_names(image))
        list += (list.empty() ? "" : ", ") + (name.empty() ? "the image itself" : name);
    throw InputError(Location{file},
                     layer.empty() ? "has no channels R, G, B, nor Y, without a layer's name"
                                   : "has no layer '" + layer + "' of a form that is known",
                     "name one with --layer; there are: " + list);
}

RgbImage picture_of_layer(const Image& image, const ImageLayer& layer, const PictureOptions& options,
                          std::string& range) {
    RgbImage picture(image.width, image.height);
    const auto value = [&](std::size_t c, std::size_t p) { return image.channel(layer.channels[c])[p]; };
    const std::size_t count = picture.pixels.size();
    const auto each = [&](auto colour) {
        for (std::size_t p = 0; p < count; ++p)
            picture.pixels[p] = colour(p);
    };
    switch (layer.kind) {
        case ImageLayer::Kind::colour: {
            const float factor = std::exp2(options.exposure);
            each([&](std::size_t p) { return Rgb(value(0, p), value(1, p), value(2, p)) * factor; });
            picture = straight_colours(std::move(picture), options.alpha);
            for (Rgb& pixel : picture.pixels)
                pixel = tone_mapped(options.tonemap, pixel);
            break;
        }
        case ImageLayer::Kind::vector: {
            bool is_short = true;
            for (std::size_t p = 0; p < count; ++p)
                is_short = is_short && !(Vec3(value(0, p), value(1, p), value(2, p)).length() > 1.01f);
            const Range ranges[] = {Range(image.channel(layer.channels[0])), Range(image.channel(layer.channels[1])),
                                    Range(image.channel(layer.channels[2]))};
            for (std::size_t c = 0; c < 3 && !is_short; ++c)
                range += range_text(image.channel_names[layer.channels[c]], ranges[c]) + "\n";
            each([&](std::size_t p) {
                const Vec3 v(value(0, p), value(1, p), value(2, p));
                if (v == Vec3(0.0f)) return Rgb(0.0f);
                Rgb c;
                for (int i = 0; i < 3; ++i)
                    c[i] = plain(is_short ? 0.5f + 0.5f * v[i] : ranges[i].normalised(v[i]));
                return c;
            });
            break;
        }
        case ImageLayer::Kind::uv:
            each([&](std::size_t p) {
                const auto part = [](float v) { return plain(v - std::floor(v)); };
                return Rgb(part(value(0, p)), part(value(1, p)), 0.0f);
            });
            break;
        case ImageLayer::Kind::numbers:
            each([&](std::size_t p) { return colour_of(value(0, p)); });
            break;
        case ImageLayer::Kind::single: {
            const std::string& name = image.channel_names[layer.channels[0]];
            const bool is_alpha = name == "A" || name.ends_with(".A");
            const Range stretched(image.channel(layer.channels[0]));
            if (!is_alpha) range = range_text(name, stretched) + "\n";
            each([&](std::size_t p) {
                const float v = value(0, p);
                return Rgb(plain(is_alpha ? v : stretched.normalised(v)));
            });
            break;
        }
    }
    return picture;
}

}  // namespace treefarm
