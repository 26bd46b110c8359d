#include "common/scene/mitsuba/film.h"

#include "common/config/parse_text.h"

namespace treefarm::mitsuba {
namespace {

constexpr std::string_view kFilms[] = {"hdrfilm", "ldrfilm"};
constexpr std::string_view kFilters[] = {"box", "tent", "gaussian"};

void use_gaussian(Film& film, double stddev) {
    film.filter = PixelFilter::gaussian;
    film.filter_stddev = static_cast<float>(stddev);
    film.filter_radius = static_cast<float>(4.0 * stddev);
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
    } else {
        diagnostics.unsupported(element.where, "the filter " + in_quotes(type) + " is not available in this version",
                                did_you_mean(type, kFilters, "use box, tent or gaussian"), "a Gaussian is used");
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

/// A window that is the whole film crops nothing.
void refuse_crop(Properties& properties, const Film& film, Diagnostics& diagnostics) {
    for (const auto& [name, whole] : {std::pair("crop_offset_x", 0), std::pair("crop_offset_y", 0),
                                      std::pair("crop_width", film.width), std::pair("crop_height", film.height)}) {
        if (properties.integer(name, whole) == whole) continue;
        diagnostics.unsupported(properties.where(name), "a crop window is not available in this version", "remove it",
                                "the whole film is rendered");
    }
}

}  // namespace

Film read_film(const XmlElement* element, const FilmSize& wanted, int version, const SceneDocument& document,
               Diagnostics& diagnostics) {
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
    film.width = read_pixels(properties, "width", film.width);
    film.height = read_pixels(properties, "height", film.height);
    refuse_crop(properties, film, diagnostics);
    if (wanted.width > 0) film.width = wanted.width;
    if (wanted.height > 0) film.height = wanted.height;
    if (const XmlElement* filter = properties.only_child("rfilter")) read_filter(*filter, film, document, diagnostics);
    // How the image is stored is not the scene's business here, and no filter crosses a pixel's own samples.
    properties.ignore({"banner", "attach_log", "file_format", "pixel_format", "component_format", "channel_names",
                       "high_quality_edges"});
    if (version >= 2) properties.ignore({"sample_border", "compensate"});
    properties.finish();
    return film;
}

}  // namespace treefarm::mitsuba
