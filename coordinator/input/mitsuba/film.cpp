// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "common/base/text/parse_text.h"
#include "coordinator/input/mitsuba/integrator_settings.h"
#include "coordinator/input/mitsuba/sensor.h"

namespace treefarm::mitsuba {
namespace {

constexpr std::string_view kFilms[] = {"hdrfilm", "ldrfilm"};
constexpr std::string_view kFilters[] = {"box", "tent", "gaussian", "mitchell", "catmullrom", "lanczos"};

void use_gaussian(Film& film, double stddev) {
    film.filter = PixelFilter::gaussian;
    film.filter_stddev = static_cast<float>(stddev);
    film.filter_radius = static_cast<float>(4.0 * stddev);
}

/// Reads B and C, which some versions of Mitsuba call A and B.
void read_cubic(Properties& properties, const std::string& type, Film& film) {
    film.filter = PixelFilter::cubic;
    film.filter_radius = 2.0f;
    film.filter_b = 0.0f;
    film.filter_c = 0.5f;
    if (type == "catmullrom") return;
    const bool from_a = properties.has("A");
    const auto number = [&](const char* name) {
        const double value = properties.number(name, 1.0 / 3.0);
        if (!(std::abs(value) <= 10.0))
            throw InputError(properties.where(name), std::string(name) + " of the filter is " + number_text(value),
                             "give -10 to 10");
        return static_cast<float>(value);
    };
    film.filter_b = number(from_a ? "A" : "B");
    film.filter_c = number(from_a ? "B" : "C");
}

void read_filter(const XmlElement& element, Film& film, const SceneDocument& document, Diagnostics& diagnostics) {
    Properties properties(element, document, diagnostics);
    const std::string type = properties.type();
    const auto check_size = [&](const char* name, double value) {
        if (!(value > 0.0 && value <= 100.0))
            throw InputError(properties.where(name),
                             std::string(name) + " of the filter is " + number_text(value) + " pixels",
                             "give more than 0 and at most 100");
        return value;
    };
    if (type == "box") {
        film.filter = PixelFilter::box;
        film.filter_radius = static_cast<float>(check_size("radius", properties.number("radius", 0.5)));
    } else if (type == "tent") {
        film.filter = PixelFilter::tent;
        film.filter_radius = static_cast<float>(check_size("radius", properties.number("radius", 1.0)));
    } else if (type == "gaussian") {
        use_gaussian(film, check_size("stddev", properties.number("stddev", 0.5)));
    } else if (type == "mitchell" || type == "catmullrom") {
        read_cubic(properties, type, film);
    } else if (type == "lanczos") {
        film.filter = PixelFilter::lanczos;
        const std::int64_t lobes = properties.integer("lobes", 3);
        if (lobes < 1 || lobes > 16)
            throw InputError(properties.where("lobes"), "a filter of " + std::to_string(lobes) + " lobes",
                             "give 1 to 16");
        film.filter_radius = static_cast<float>(lobes);
    } else {
        diagnostics.unsupported(
            element.where, "the filter " + in_quotes(type) + " is not available in this version",
            did_you_mean(type, kFilters, "use box, tent, gaussian, mitchell, catmullrom or lanczos"),
            "a Gaussian is used");
        use_gaussian(film, 0.5);
        return;
    }
    properties.finish();
}

int read_pixels(Properties& properties, const char* name, int otherwise) {
    const std::int64_t pixels = properties.integer(name, otherwise);
    if (pixels < 1 || pixels > 65535)
        throw InputError(properties.where(name),
                         "the film's " + std::string(name) + " is " + std::to_string(pixels) + " pixels",
                         "give 1 to 65535");
    return static_cast<int>(pixels);
}

/// Pixels [begin, end) along a side of the film.
struct Span {
    int begin, end;
};

/// Pixels of the crop window along a side of `side` pixels.
Span read_crop(Properties& properties, const char* offset, const char* size, int side) {
    const std::int64_t begin = properties.integer(offset, 0), pixels = properties.integer(size, side);
    if (begin < 0)
        throw InputError(
            properties.where(offset), std::string(offset) + " is " + std::to_string(begin),
            "give 0 to " + std::to_string(std::max<std::int64_t>(0, side - std::max<std::int64_t>(pixels, 1))));
    if (begin >= side || pixels < 1 || pixels > side - begin)
        throw InputError(
            properties.where(properties.has(size) ? size : offset),
            "the crop window has pixels " + std::to_string(begin) + " to " + std::to_string(begin + pixels - 1) +
                " of " + std::to_string(side),
            "keep it on the film: " + std::string(offset) + " + " + size + " is at most " + std::to_string(side));
    return {static_cast<int>(begin), static_cast<int>(begin + pixels)};
}

/// The span on a side of another size: all pixels that it touches.
Span scaled(const Span& span, std::int64_t from, std::int64_t to) {
    return {static_cast<int>(span.begin * to / from), static_cast<int>((span.end * to + from - 1) / from)};
}

/// Reads size and crop window. A wanted size is that of the whole film and scales the window.
void read_size(Properties& properties, const FilmSize& wanted, Film& film) {
    const int width = read_pixels(properties, "width", film.width);
    const int height = read_pixels(properties, "height", film.height);
    Span x = read_crop(properties, "crop_offset_x", "crop_width", width);
    Span y = read_crop(properties, "crop_offset_y", "crop_height", height);
    const int whole_width = wanted.width > 0 ? wanted.width : width;
    const int whole_height = wanted.height > 0 ? wanted.height : height;
    x = scaled(x, width, whole_width);
    y = scaled(y, height, whole_height);
    film.width = x.end - x.begin;
    film.height = y.end - y.begin;
    if (film.width < whole_width || film.height < whole_height)
        film.crop = {x.begin, y.begin, whole_width, whole_height};
}

}  // namespace

Film read_film(const XmlElement* element, const FilmSize& wanted, int version, std::vector<Setting>& settings,
               const SceneDocument& document, Diagnostics& diagnostics) {
    Film film;
    use_gaussian(film, 0.5);
    if (element == nullptr) {
        if (wanted.width > 0) film.width = wanted.width;
        if (wanted.height > 0) film.height = wanted.height;
        return film;
    }
    Properties properties(*element, document, diagnostics);
    const std::string type = properties.type();
    if (type == "ldrfilm") {
        diagnostics.warn(element->where,
                         "<film type=\"ldrfilm\"> gives the size and the filter only: the image is "
                         "written as linear OpenEXR");
    } else if (type != "hdrfilm") {
        diagnostics.unsupported(element->where, "the film " + in_quotes(type) + " is not available in this version",
                                did_you_mean(type, kFilms, "use hdrfilm"), "it is read as hdrfilm");
    }
    // Scenes keep these when their film becomes an hdrfilm. None of them changes the linear image.
    properties.ignore({"gamma", "exposure", "tonemap_method", "key", "burn", "digits", "variable"});
    read_size(properties, wanted, film);
    if (const XmlElement* filter = properties.only_child("rfilter")) read_filter(*filter, film, document, diagnostics);
    if (properties.tag_of("pixel_format") == "string") {
        const std::string format = lower_case(properties.text("pixel_format", ""));
        if (format == "rgba" || format == "luminance_alpha" || format == "luminancealpha" || format == "xyza")
            IntegratorSettings::add_aovs(settings, "alpha", properties.where("pixel_format"));
    }
    // The storage of the image is the job's business, and filters do not cross the samples of a pixel.
    properties.ignore({"banner", "attach_log", "file_format", "pixel_format", "component_format", "channel_names",
                       "high_quality_edges"});
    if (version >= 2) properties.ignore({"sample_border", "compensate"});
    properties.finish();
    return film;
}

}  // namespace treefarm::mitsuba
