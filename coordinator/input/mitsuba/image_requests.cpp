// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/mitsuba/image_requests.h"

#include <algorithm>
#include <cmath>

#include "common/base/text/parse_text.h"
#include "coordinator/input/images/stored_image.h"
#include "coordinator/input/mitsuba/colors.h"

namespace treefarm::mitsuba {
namespace {

double decoded(double value, double gamma) {
    if (gamma == Decoding::kSrgb) return srgb_to_linear(value);
    return gamma == 1.0 ? value : std::pow(value, gamma);
}

/// The exponent to apply; 1 for files of linear floats.
double gamma_of(const StoredImage& file, const Decoding& decoding) {
    if (decoding.gamma != Decoding::kAuto) return decoding.gamma;
    if (!file.integers) return 1.0;
    return decoding.file_gamma && file.gamma > 0.0 ? file.gamma : Decoding::kSrgb;
}

/// Indices of the needed channels among those of the file.
std::vector<std::size_t> choose_channels(const StoredImage& file, const std::string& wanted, const Location& where) {
    std::vector<std::size_t> chosen;
    std::string present;
    for (std::size_t i = 0; i < file.channels.size(); ++i) {
        const char letter = static_cast<char>(file.channels[i][0] - 'A' + 'a');
        if (wanted.empty() ? letter != 'a' : wanted == std::string(1, letter)) chosen.push_back(i);
        present += (present.empty() ? "" : ", ") + std::string(1, letter);
    }
    if (chosen.empty())
        throw InputError(where, "the image has no channel " + in_quotes(wanted), "choose one of " + present);
    return chosen;
}

template <class T>
std::vector<T> pick(const std::vector<T>& values, std::size_t stride, const std::vector<std::size_t>& chosen) {
    if (chosen.size() == stride) return values;
    std::vector<T> picked;
    picked.reserve(values.size() / stride * chosen.size());
    for (std::size_t at = 0; at < values.size(); at += stride)
        for (const std::size_t channel : chosen)
            picked.push_back(values[at + channel]);
    return picked;
}

void expand_to_floats(TextureImage& image) {
    std::vector<float> source = std::move(image.floats);
    for (const std::uint8_t byte : image.bytes)
        source.push_back(image.decode[byte]);
    image.bytes.clear();
    image.floats.clear();
    if (image.channels == 3) {
        image.floats = std::move(source);
        return;
    }
    image.channels = 3;
    image.floats.reserve(source.size() * 3);
    for (const float value : source)
        image.floats.insert(image.floats.end(), 3, value);
}

/// Whether a texel of an image of three channels has a colour.
bool is_coloured(const TextureImage& image) {
    const auto differ = [](const auto& values) {
        for (std::size_t i = 0; i + 2 < values.size(); i += 3)
            if (values[i] != values[i + 1] || values[i] != values[i + 2]) return true;
        return false;
    };
    return image.channels == 3 && (differ(image.bytes) || differ(image.floats));
}

/// Replaces three channels by their luminance. Grey images stay as they are: their mean is the same.
void take_luminance(TextureImage& image) {
    std::vector<float> grey(image.bytes.size() / 3 + image.floats.size() / 3);
    for (std::size_t i = 0; i < grey.size(); ++i)
        grey[i] =
            luminance(image.bytes.empty() ? Rgb(image.floats[3 * i], image.floats[3 * i + 1], image.floats[3 * i + 2])
                                          : Rgb(image.decode[image.bytes[3 * i]], image.decode[image.bytes[3 * i + 1]],
                                                image.decode[image.bytes[3 * i + 2]]));
    image.bytes.clear();
    image.floats = std::move(grey);
    image.channels = 1;
}

/// Largest half-precision number, which programs write for infinity.
constexpr float kLargestHalf = 65504.0f;

/// Numbers of changed values.
struct Repairs {
    std::size_t infinite = 0, impossible = 0;
};

/// Replaces infinite light by the largest half, and values impossible for light and surfaces by 0.
Repairs repair(std::vector<float>& values, const Decoding& decoding) {
    Repairs repairs;
    for (float& value : values) {
        if (std::isinf(value) && value > 0.0f && decoding.is_light) {
            value = kLargestHalf;
            ++repairs.infinite;
        } else if (!std::isfinite(value) || (value < 0.0f && !decoding.signed_values)) {
            value = 0.0f;
            ++repairs.impossible;
        }
    }
    return repairs;
}

TextureImage make_image(const StoredImage& file, const Decoding& decoding, const Location& where,
                        Diagnostics& diagnostics) {
    const std::vector<std::size_t> chosen = choose_channels(file, decoding.channel, decoding.channel_where);
    const double gamma = decoding.channel == "a" ? 1.0 : gamma_of(file, decoding);
    TextureImage image;
    image.width = file.width;
    image.height = file.height;
    image.channels = static_cast<int>(chosen.size());
    image.bytes = pick(file.bytes, file.channels.size(), chosen);
    image.floats = pick(file.floats, file.channels.size(), chosen);
    if (!image.bytes.empty()) {
        for (std::size_t i = 0; i < image.decode.size(); ++i)
            image.decode[i] = static_cast<float>(decoded(static_cast<double>(i) / 255.0, gamma));
    } else if (gamma != 1.0) {
        for (float& value : image.floats)
            value = value > 0.0f ? static_cast<float>(decoded(double(value), gamma)) : value;
    }
    const Repairs repairs = repair(image.floats, decoding);
    if (repairs.infinite > 0)
        diagnostics.warn(where,
                         std::to_string(repairs.infinite) +
                             " values of the image are infinite and were set to 65504, the largest half",
                         "numbers");
    if (repairs.impossible > 0)
        diagnostics.warn(
            where,
            std::to_string(repairs.impossible) + " values of the image are negative or not finite and were set to 0",
            "numbers");
    if (decoding.number != TexelNumber::none && is_coloured(image)) {
        const bool mean = decoding.number == TexelNumber::mean;
        diagnostics.note(where, std::string("a coloured image stands for a number: ") +
                                    (mean ? "the mean of its channels counts, as in Mitsuba 0.6; its property channel "
                                            "(r, g, b or a) chooses one"
                                          : "its luminance counts, as in Mitsuba; if one channel is meant, save that "
                                            "as a grey image"));
        if (!mean) take_luminance(image);
    }
    if (decoding.as_floats) expand_to_floats(image);
    return image;
}

}  // namespace

std::int32_t ImageRequests::add(const std::filesystem::path& path, const Decoding& decoding, const Location& where,
                                Scene& scene) {
    const auto [entry, is_new] =
        known_.emplace(std::pair(path.lexically_normal(), decoding), static_cast<std::int32_t>(scene.images.size()));
    if (!is_new) return entry->second;
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error))
        throw InputError(where, "there is no image file " + path_in_quotes(path.string()), "check the path");
    requests_.push_back({path, decoding, where, entry->second});
    TextureImage image;
    image.name = path.string();
    scene.images.push_back(std::move(image));
    return entry->second;
}

double ImageRequests::aspect(std::int32_t image) const {
    const auto request =
        std::find_if(requests_.begin(), requests_.end(), [&](const Request& r) { return r.image == image; });
    if (request == requests_.end()) return 1.0;
    const StoredImage file = read_stored_image(request->path);
    return static_cast<double>(file.width) / file.height;
}

void ImageRequests::read(const std::vector<std::int32_t>& kept, Scene& scene, Diagnostics& diagnostics) const {
    const std::filesystem::path* loaded = nullptr;
    StoredImage file;
    for (const Request& request : requests_) {
        const std::int32_t index = kept[static_cast<std::size_t>(request.image)];
        if (index == kNone) continue;
        diagnostics.attempt([&] {
            if (loaded == nullptr || *loaded != request.path) {
                loaded = nullptr;
                // Checked again, since names in material libraries were not checked before.
                diagnostics.limits().check_file(request.path, request.where);
                file = read_stored_image(request.path, diagnostics.limits().image_pixels);
                loaded = &request.path;
            }
            if (file.width > 65535 || file.height > 65535)
                throw InputError(
                    request.where,
                    "the image has " + std::to_string(file.width) + " x " + std::to_string(file.height) + " pixels",
                    "reduce it to at most 65535 on a side");
            TextureImage image = make_image(file, request.decoding, request.where, diagnostics);
            image.name = request.path.string();
            scene.images[static_cast<std::size_t>(index)] = std::move(image);
        });
    }
}

}  // namespace treefarm::mitsuba
