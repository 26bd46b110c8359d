// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/mitsuba/spectrum_plugins.h"

#include "common/base/text/parse_text.h"
#include "coordinator/input/mitsuba/colors.h"
#include "coordinator/input/mitsuba/values.h"

namespace treefarm::mitsuba {
namespace {

using Rgb64 = Imath::Color3<double>;

std::vector<double> number_list(Properties& properties, const char* name) {
    if (!properties.has(name))
        throw InputError(properties.where(), properties.title() + " has no " + in_quotes(name),
                         "add <string name=" + in_quotes(name) + " value=\"...\"/>");
    return numbers_of(properties.text(name, ""), properties.where(name));
}

double required_number(Properties& properties, const char* name) {
    if (!properties.has(name))
        throw InputError(properties.where(), properties.title() + " has no " + in_quotes(name),
                         "add <float name=" + in_quotes(name) + " value=\"...\"/>");
    return properties.number(name, 0.0);
}

SpectrumSamples pairs(const std::vector<double>& wavelengths, const std::vector<double>& values,
                      const Properties& properties) {
    if (wavelengths.size() != values.size() || values.size() < 2)
        throw InputError(properties.where("values"),
                         properties.title() + " has " + std::to_string(wavelengths.size()) + " wavelengths and " +
                             std::to_string(values.size()) + " values",
                         "give two or more, as many of one as of the other");
    SpectrumSamples samples;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (i > 0 && !(wavelengths[i] > wavelengths[i - 1]))
            throw InputError(properties.where("wavelengths"), "the wavelengths of a spectrum do not rise", "sort them");
        samples.emplace_back(wavelengths[i], values[i]);
    }
    return samples;
}

SpectrumSamples regular(Properties& properties) {
    const std::vector<double> values = number_list(properties, "values");
    const double first = required_number(properties, "wavelength_min"),
                 last = required_number(properties, "wavelength_max");
    std::vector<double> wavelengths;
    for (std::size_t i = 0; i < values.size(); ++i)
        wavelengths.push_back(first + (last - first) * static_cast<double>(i) /
                                          static_cast<double>(std::max<std::size_t>(values.size() - 1, 1)));
    return pairs(wavelengths, values, properties);
}

SpectrumSamples irregular(Properties& properties) {
    const std::vector<double> wavelengths = number_list(properties, "wavelengths");
    return pairs(wavelengths, number_list(properties, "values"), properties);
}

Rgb64 raw_constant(Properties& properties) {
    const std::string tag = properties.tag_of("value");
    if (tag == "vector" || tag == "point") return Rgb64(properties.point("value", Vec3(0.0f)));
    return Rgb64(required_number(properties, "value"));
}

}  // namespace

std::optional<Rgb> read_spectrum_plugin(Properties& properties, ColorUse use, Diagnostics& diagnostics) {
    const std::string type = properties.type();
    const auto checked = [&](const Rgb64& color, bool of_list) {
        return checked_color(color, of_list, false, use, properties.where(), diagnostics);
    };
    const auto list = [&](const SpectrumSamples& samples) {
        return checked(color_of_list(samples, properties.element(), use), true);
    };
    if (type == "uniform") {
        properties.ignore({"wavelength_min", "wavelength_max"});
        return checked(Rgb64(required_number(properties, "value")), false);
    }
    if (type == "rawconstant") return checked(raw_constant(properties), false);
    if (type == "srgb") {
        properties.ignore({"unbounded"});
        return properties.color("color", Rgb(1.0f), use);
    }
    if (type == "d65") {
        const double scale = properties.number("scale", 1.0);
        return checked(Rgb64(properties.color("color", Rgb(1.0f), ColorUse::coefficient)) * scale, false);
    }
    if (type == "regular") return list(regular(properties));
    if (type == "irregular") return list(irregular(properties));
    if (type == "blackbody") {
        if (use != ColorUse::radiance)
            throw InputError(properties.where(), properties.title() + " is light, not a property of a surface",
                             "give an <rgb>");
        properties.ignore({"wavelength_min", "wavelength_max"});
        return checked(blackbody_color(required_number(properties, "temperature"), properties.where("temperature")),
                       true);
    }
    return std::nullopt;
}

}  // namespace treefarm::mitsuba
