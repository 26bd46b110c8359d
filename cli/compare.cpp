// SPDX-License-Identifier: Apache-2.0
#include "cli/compare.h"

#include <CLI/CLI.hpp>
#include <charconv>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>

#include "cli/commands.h"
#include "cli/compare_output.h"
#include "cli/option_values.h"
#include "common/base/error.h"
#include "common/image/exr.h"
#include "common/image/png.h"
#include "common/metrics/difference.h"
#include "common/metrics/false_colour.h"

namespace treefarm {

namespace {

constexpr const char* kSppAttribute = "treefarm.spp";
constexpr double kFloorPerSample = 1e-4;  ///< least variance of one sample, as in Mitsuba 3's render tests
constexpr std::uint64_t kAssumedSpp = 10000;
constexpr double kLeastPpd = 1.0, kGreatestPpd = 1000.0;

/// An image with its colours, variance (if the file has it) and header data.
struct Side {
    RgbImage colour;
    std::optional<RgbImage> variance;
    bool half = false;
    std::optional<std::uint64_t> spp;
    CropWindow crop;
};

std::optional<std::uint64_t> samples_per_pixel(const Attributes& attributes) {
    const auto at = attributes.find(kSppAttribute);
    if (at == attributes.end()) return std::nullopt;
    const std::string& text = at->second;
    std::uint64_t spp = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), spp);
    if (error != std::errc() || end != text.data() + text.size() || spp == 0) return std::nullopt;
    return spp;
}

Side read_side(const std::string& path) {
    ExrImage file = read_exr(path, [](const std::string& name) {
        return name.find('.') == std::string::npos || name.starts_with("variance.");
    });
    const auto colour = rgb_layer(file.image);
    if (!colour)
        throw InputError(Location{path}, "has neither the channels R, G, B nor Y",
                         "check which channels it has (exrheader)");
    Side side{*colour, rgb_layer(file.image, "variance"), false, samples_per_pixel(file.attributes), file.image.crop};
    for (std::size_t c = 0; c < file.types.size(); ++c) {
        const std::string& name = file.image.channel_names[c];
        const bool is_colour = name == "R" || name == "G" || name == "B" || name == "Y";
        side.half = side.half || (is_colour && file.types[c] == PixelType::half);
    }
    return side;
}

/// Cuts the part of `window` out of a whole image.
void cut_to_window(Side& whole, const Side& window) {
    const CropWindow& crop = window.crop;
    if (whole.crop.is_window() || !crop.is_window() || whole.colour.width != crop.whole_width ||
        whole.colour.height != crop.whole_height)
        return;
    whole.colour = cut_out(whole.colour, crop, window.colour.width, window.colour.height);
    if (whole.variance) whole.variance = cut_out(*whole.variance, crop, window.colour.width, window.colour.height);
    whole.crop = crop;
}

/// Sets the reference's variance from the image's, by --reference-spp; returns a description of its origin.
std::string reference_variance(const CompareOptions& options, const Side& image, Side& reference) {
    if (options.reference_spp == 0) {
        if (reference.variance) return "variance channels of the reference";
        return "none: it counts as exact";
    }
    if (!image.spp || !image.variance)
        throw InputError(Location{options.image},
                         "--reference-spp needs an image with variance channels and the attribute treefarm.spp",
                         "leave out --reference-spp, or compare an image that treefarm rendered");
    const double factor = static_cast<double>(*image.spp) / static_cast<double>(options.reference_spp);
    reference.variance = image.variance;
    for (Rgb& v : reference.variance->pixels)
        v *= static_cast<float>(factor);
    return "that of the image times " + std::to_string(*image.spp) + " / " + std::to_string(options.reference_spp) +
           " (an estimator like the image's)";
}

void run_z_tests(const CompareOptions& options, const Side& image, Side& reference, Comparison& result) {
    result.reference_noise = reference_variance(options, image, reference);
    if (reference.half) result.reference_noise += ", and rounding to half";
    if (!image.variance) {
        result.z_unavailable = options.image +
                               " has no variance channels (variance.R, variance.G, variance.B), so the effect of its "
                               "noise alone is unknown";
        return;
    }
    const ZTestInput input{
        image.colour, reference.colour, &*image.variance,       reference.variance ? &*reference.variance : nullptr,
        image.half,   reference.half,   options.reference_error};
    ZTestOptions z;
    z.block = options.block;
    z.variance_floor = kFloorPerSample / static_cast<double>(image.spp.value_or(kAssumedSpp));
    result.z_options = z;
    result.pixel_test = pixel_z_test(input, z);
    result.block_test = block_z_test(input, z);
}

bool has_extension(const std::string& path, const char* extension) {
    return std::filesystem::path(path).extension() == extension;
}

/// Checks option values that CLI11 misses: its ranges accept NaN.
void check_options(const CompareOptions& options) {
    if (!(options.reference_error >= 0.0 && options.reference_error <= 1.0))
        throw InputError(Location{"--reference-error"}, "is not a number", "give 0 to 1, e.g. 0.001");
    if (!(options.flip_ppd >= kLeastPpd && options.flip_ppd <= kGreatestPpd))
        throw InputError(Location{"--flip-ppd"}, "is not a number", "give 1 to 1000, e.g. 67");
    if (!options.error_map.empty() && !has_extension(options.error_map, ".png") &&
        !has_extension(options.error_map, ".exr"))
        throw InputError(Location{options.error_map}, "--error-map writes PNG and EXR, and the name says neither",
                         "end it in .png (false colour) or .exr (values)");
}

void write_error_map(const std::string& path, const Plane& map) {
    if (has_extension(path, ".png")) return write_png(path, false_colour(map));
    Image image;
    image.width = map.width;
    image.height = map.height;
    const std::span<float> channel = image.add_channel("Y");
    std::copy(map.values.begin(), map.values.end(), channel.begin());
    write_exr(path, image);
}

}  // namespace

int run_compare(const CompareOptions& options, std::ostream& out) {
    check_options(options);
    Side image = read_side(options.image);
    Side reference = read_side(options.reference);
    cut_to_window(reference, image);
    cut_to_window(image, reference);
    if (image.colour.width != reference.colour.width || image.colour.height != reference.colour.height)
        throw InputError(Location{options.image},
                         "has " + std::to_string(image.colour.width) + " x " + std::to_string(image.colour.height) +
                             " pixels, " + options.reference + " has " + std::to_string(reference.colour.width) +
                             " x " + std::to_string(reference.colour.height),
                         "only images of one size can be compared, or a crop window with a whole");
    if (image.crop != reference.crop && image.crop.is_window() && reference.crop.is_window())
        throw InputError(Location{options.image}, "shows another part of the film than " + options.reference,
                         "only images of one crop window can be compared");
    Comparison result;
    result.image = options.image;
    result.reference = options.reference;
    result.width = image.colour.width;
    result.height = image.colour.height;
    result.image_spp = image.spp;
    result.errors = measure_error(image.colour, reference.colour, options.block);
    result.flip = measure_flip(image.colour, reference.colour, options.flip_ppd);
    run_z_tests(options, image, reference, result);
    if (!options.error_map.empty()) write_error_map(options.error_map, result.flip.hdr_map);
    if (!options.difference.empty()) write_png(options.difference, difference_image(image.colour, reference.colour));
    options.json ? print_json(result, out) : print_table(result, out);
    return 0;
}

void add_compare_command(CLI::App& app, const LaunchEnvironment& launch, int& exit_code) {
    const auto options = std::make_shared<CompareOptions>();
    CLI::App* command = app.add_subcommand("compare", "measure an image against a reference, and test it for bias");
    command->add_option("IMAGE", options->image, "EXR image")->required();
    command->add_option("REFERENCE", options->reference, "EXR image of the same size")->required();
    command->add_flag("--json", options->json, "print JSON instead of a table");
    add_text_option(*command, "--difference", options->difference,
                    "write a PNG of the signed relative difference (blue: too dark, red: too bright)");
    add_text_option(*command, "--error-map", options->error_map,
                    "write FLIP per pixel, as false colour to a .png, as channel Y to an .exr");
    add_number_option(*command, "--flip-ppd", options->flip_ppd, {kLeastPpd, kGreatestPpd, "pixels per degree", "67"},
                      "pixels per degree of visual angle for FLIP (67: a 4K screen 0.7 m wide, 0.7 m away)");
    add_integer_option(*command, "--block", options->block, {1, 65536, "pixels", "16"},
                       "side of the blocks of the block test, in pixels (16)");
    add_integer_option(
        *command, "--reference-spp", options->reference_spp, {1, 1099511627776, "samples per pixel", "4096"},
        "samples per pixel of a reference without variance channels: its noise is taken from the image's");
    add_number_option(*command, "--reference-error", options->reference_error, {0, 1, "a fraction", "0.001"},
                      "standard deviation of a relative error common to all of the reference, e.g. 0.001");
    command->callback([options, launch, &exit_code] {
        if (launch.rank == 0) exit_code = run_compare(*options, std::cout);  // under mpirun one process is enough
    });
}

}  // namespace treefarm
