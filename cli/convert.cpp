// SPDX-License-Identifier: Apache-2.0
#include "cli/convert.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <memory>

#include "cli/commands.h"
#include "cli/option_values.h"
#include "cli/picture_of_layer.h"
#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/base/text/parse_text.h"
#include "common/image/exr.h"
#include "common/image/png.h"

namespace treefarm {

namespace {

constexpr double kMostStops = 60;

/// Image of one layer: its channels without the layer's name, colours scaled by the exposure.
Image layer_alone(const Image& image, const ImageLayer& layer, float factor) {
    Image alone{image.width, image.height, {}, {}, image.crop};
    for (const std::size_t c : layer.channels) {
        const std::string& name = image.channel_names[c];
        const std::size_t dot = name.rfind('.');
        const std::span<float> channel = alone.add_channel(dot == std::string::npos ? name : name.substr(dot + 1));
        const std::span<const float> values = image.channel(c);
        std::transform(values.begin(), values.end(), channel.begin(), [factor](float v) { return v * factor; });
    }
    return alone;
}

/// PFM file (little-endian, rows from the bottom) of one or three channels; two get a third one of zeros.
std::vector<std::uint8_t> encode_pfm(const Image& image) {
    const std::size_t channels = image.channel_names.size() == 1 ? 1 : 3;
    const std::string header = std::string(channels == 1 ? "Pf\n" : "PF\n") + std::to_string(image.width) + " " +
                               std::to_string(image.height) + "\n-1.0\n";
    std::vector<std::uint8_t> bytes(header.begin(), header.end());
    const auto width = static_cast<std::size_t>(image.width), height = static_cast<std::size_t>(image.height);
    bytes.reserve(bytes.size() + 4 * channels * image.pixel_count());
    for (std::size_t y = height; y-- > 0;)
        for (std::size_t x = 0; x < width; ++x)
            for (std::size_t c = 0; c < channels; ++c) {
                const float value = c < image.channel_names.size() ? image.channel(c)[y * width + x] : 0.0f;
                std::uint32_t bits;
                std::memcpy(&bits, &value, sizeof bits);
                for (int shift = 0; shift < 32; shift += 8)
                    bytes.push_back(static_cast<std::uint8_t>(bits >> shift));
            }
    return bytes;
}

ToneMap tone_map_of(const ConvertOptions& options, const std::string& extension, ImageLayer::Kind kind) {
    if (options.tonemap.empty()) return ToneMap::srgb;
    const auto map = find_tone_map(options.tonemap);
    if (!map)
        throw InputError(Location{"--tonemap"}, "there is no tone map " + in_quotes(options.tonemap),
                         "use srgb, aces or reinhard");
    if (extension != ".png")
        throw InputError(Location{"--tonemap"}, "an " + extension.substr(1) + " file holds radiance, not a picture",
                         "leave it out, or write a .png");
    if (kind != ImageLayer::Kind::colour)
        throw InputError(Location{"--tonemap"}, "the layer is no colour", "leave it out");
    return *map;
}

}  // namespace

void run_convert(const ConvertOptions& options, std::ostream& out) {
    const std::string extension = std::filesystem::path(options.output).extension().string();
    if (extension != ".png" && extension != ".exr" && extension != ".pfm")
        throw InputError(Location{options.output}, "convert writes PNG, EXR and PFM, and the name says none of them",
                         "end it in .png, .exr or .pfm");
    std::error_code none;
    if (std::filesystem::equivalent(options.image, options.output, none))
        throw InputError(Location{options.output}, "is the image that is read", "give the result another name");
    const ExrImage file = read_exr(options.image);
    const ImageLayer layer = find_image_layer(file.image, options.layer, options.image);
    const ToneMap tonemap = tone_map_of(options, extension, layer.kind);
    const auto stops = static_cast<float>(options.exposure);
    if (stops != 0.0f && layer.kind != ImageLayer::Kind::colour)
        throw InputError(Location{"--exposure"}, "the layer is no colour", "leave it out");
    const bool has_alpha = options.layer.empty() && layer.kind == ImageLayer::Kind::colour;
    if (extension == ".png") {
        std::string range;
        const std::span<const float> alpha = has_alpha ? alpha_of(file.image) : std::span<const float>();
        const RgbImage picture = picture_of_layer(file.image, layer, {stops, tonemap, alpha}, range);
        write_file_atomically(options.output, encode_png(picture, 1.0f, alpha));
        out << range;
        return;
    }
    Image alone = layer_alone(file.image, layer, std::exp2(stops));
    if (extension == ".exr") {
        if (const auto alpha = alpha_of(file.image); has_alpha && !alpha.empty())
            std::copy(alpha.begin(), alpha.end(), alone.add_channel("A").begin());
        write_exr(options.output, alone);
    }
    if (extension == ".pfm") write_output_file(options.output, encode_pfm(alone));
}

void add_convert_command(CLI::App& app, const LaunchEnvironment& launch, int& exit_code) {
    const auto options = std::make_shared<ConvertOptions>();
    CLI::App* command = app.add_subcommand("convert", "make a picture of an image, or of one of its layers");
    command->add_option("IMAGE", options->image, "EXR image")->required();
    command->add_option("OUT", options->output, "file to write: .png (to look at), .exr or .pfm (the values)")
        ->required();
    add_text_option(*command, "--layer", options->layer,
                    "layer of the image: albedo, normal, depth... (default: its colours)");
    add_number_option(*command, "--exposure", options->exposure, {-kMostStops, kMostStops, "stops", "1.5"},
                      "multiply colours by two to the power of so many stops (0)");
    add_text_option(*command, "--tonemap", options->tonemap,
                    "of a PNG: srgb (clamped), aces (fit of Narkowicz 2015) or reinhard (L / (1 + L)) (srgb)");
    command->callback([options, launch, &exit_code] {
        if (launch.rank != 0) return;  // under mpirun one process is enough
        run_convert(*options, std::cout);
        exit_code = 0;
    });
}

}  // namespace treefarm
