// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "common/base/text/parse_text.h"
#include "coordinator/input/mitsuba/colors.h"
#include "coordinator/input/mitsuba/values.h"

namespace treefarm::mitsuba {

Imath::Color3<double> blackbody_color(double temperature, const Location& where) {
    if (!(temperature > 0.0 && temperature <= 1e6))
        throw InputError(where, "a temperature of " + number_text(temperature) + " kelvin",
                         "give more than 0 and at most a million");
    // Speed of light, Planck's and Boltzmann's constants (SI, exact since 2019).
    constexpr double c = 299792458.0, h = 6.62607015e-34, k = 1.380649e-23;
    SpectrumSamples samples;
    for (int nanometres = 360; nanometres <= 830; nanometres += 5) {
        const double wavelength = nanometres * 1e-9;
        const double power =
            2.0 * h * c * c / std::pow(wavelength, 5.0) / std::expm1(h * c / (k * wavelength * temperature));
        samples.emplace_back(nanometres, power * 1e-9);
    }
    return spectrum_to_rgb(samples, false);
}

Imath::Color3<double> read_blackbody(const XmlElement& element) {
    element.allow_attributes({"name", "temperature", "scale"});
    std::string_view text = trim(element.require("temperature"));
    if (text.ends_with('K') || text.ends_with('k')) text.remove_suffix(1);
    const std::string* scale = element.find("scale");
    return blackbody_color(number_of(text, element.where), element.where) *
           (scale ? number_of(*scale, element.where) : 1.0);
}

}  // namespace treefarm::mitsuba
