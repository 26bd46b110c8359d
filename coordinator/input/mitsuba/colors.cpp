// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/mitsuba/colors.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "common/base/text/parse_text.h"
#include "coordinator/input/mitsuba/values.h"

namespace treefarm::mitsuba {
namespace {

using Rgb64 = Imath::Color3<double>;

/// Extends a list that does not end at zero to fall to zero over its mean spacing at either end, as Mitsuba 0.6 does.
SpectrumSamples extend_to_zero(SpectrumSamples samples) {
    const double spacing = (samples.back().first - samples.front().first) / static_cast<double>(samples.size() - 1);
    if (samples.front().second != 0.0) samples.insert(samples.begin(), {samples.front().first - spacing, 0.0});
    if (samples.back().second != 0.0) samples.emplace_back(samples.back().first + spacing, 0.0);
    return samples;
}

/// Spectrum as Mitsuba 0.5 evaluates it: between two samples it runs backwards, from the second value to the first
/// (InterpolatedSpectrum::eval; fixed in 0.6). Scenes of that version look as published only in this way: the light of
/// the published Cornell box would be too bright in red. The result has each inner wavelength twice.
SpectrumSamples reverse_segments(const SpectrumSamples& samples) {
    SpectrumSamples reversed;
    for (std::size_t i = 0; i + 1 < samples.size(); ++i) {
        reversed.emplace_back(samples[i].first, samples[i + 1].second);
        reversed.emplace_back(samples[i + 1].first, samples[i].second);
    }
    return reversed;
}

SpectrumSamples parse_list(const std::vector<std::string_view>& tokens, const Location& where) {
    SpectrumSamples samples;
    for (const std::string_view token : tokens) {
        const std::size_t colon = token.find(':');
        if (colon == std::string_view::npos)
            throw InputError(where, in_quotes(token) + " in a spectrum is no pair \"wavelength:value\"",
                             "write for instance \"400:0.3, 700:0.6\"");
        const double wavelength = number_of(token.substr(0, colon), where);
        const double value = number_of(token.substr(colon + 1), where);
        if (!samples.empty() && wavelength <= samples.back().first)
            throw InputError(where, "the wavelengths of a spectrum do not rise at " + in_quotes(token), "sort them");
        samples.emplace_back(wavelength, value);
    }
    if (samples.size() < 2)
        throw InputError(where, "a list of wavelengths needs at least two of them",
                         "give a single value, or more pairs");
    return samples;
}

/// Three values from 0 to 1 for "#rrggbb".
std::optional<Rgb64> parse_hex(std::string_view text) {
    if (text.size() != 7 || text[0] != '#') return std::nullopt;
    Rgb64 color;
    for (int i = 0; i < 3; ++i) {
        int channel = 0;
        for (const char c : text.substr(1 + 2 * static_cast<std::size_t>(i), 2)) {
            const std::size_t digit =
                std::string_view("0123456789abcdef").find(static_cast<char>(c | ('A' <= c && c <= 'Z' ? 0x20 : 0)));
            if (digit == std::string_view::npos) return std::nullopt;
            channel = channel * 16 + static_cast<int>(digit);
        }
        color[i] = channel / 255.0;
    }
    return color;
}

Rgb64 parse_triple(const XmlElement& element) {
    const std::string& text = element.require("value");
    if (const auto color = parse_hex(trim(text))) return *color;
    const std::vector<double> values = numbers_of(text, element.where);
    if (values.size() == 1) return Rgb64(values[0]);
    if (values.size() != 3)
        throw InputError(element.where,
                         "<" + element.tag + "> has " + std::to_string(values.size()) + " values, not 1 or 3",
                         "write for instance \"0.8, 0.2, 0.2\"");
    return {values[0], values[1], values[2]};
}

Rgb64 read_spectrum(const XmlElement& element, ColorUse use) {
    const std::string& text = element.require("value");
    const std::vector<std::string_view> tokens = split_list(text);
    if (tokens.empty()) throw InputError(element.where, "<spectrum> is empty", "give a value");
    if (text.find(':') != std::string::npos) return color_of_list(parse_list(tokens, element.where), element, use);
    const std::vector<double> values = numbers_of(text, element.where);
    if (values.size() == 3 && element.version == 0) return {values[0], values[1], values[2]};
    if (values.size() != 1)
        throw InputError(element.where,
                         "<spectrum> has " + std::to_string(values.size()) + " values without wavelengths",
                         "give one value, pairs \"wavelength:value\", or use <rgb>");
    // From version 2 on, a light of equal energy at all wavelengths has its true colour, which is not white.
    if (use == ColorUse::radiance && element.version >= 2) return xyz_to_rgb(1.0, 1.0, 1.0) * values[0];
    return Rgb64(values[0]);
}

}  // namespace

Rgb64 color_of_list(const SpectrumSamples& samples, const XmlElement& element, ColorUse use) {
    if (element.is_0_5) return spectrum_to_rgb(reverse_segments(extend_to_zero(samples)), false);
    if (element.version == 0) return spectrum_to_rgb(extend_to_zero(samples), false);
    return spectrum_to_rgb(samples, element.version >= 3 && use != ColorUse::radiance);
}

Rgb checked_color(Rgb64 color, bool of_list, bool is_old, ColorUse use, const Location& where,
                  Diagnostics& diagnostics) {
    if (of_list)
        for (int i = 0; i < 3; ++i)
            color[i] = std::max(color[i], 0.0);
    const double largest = std::max({color.x, color.y, color.z});
    if (use == ColorUse::reflectance && largest > 1.0 && is_old && std::isfinite(largest)) {
        diagnostics.warn(where,
                         "a reflectance of " + number_text(largest) + " was scaled down to 0.99, as by Mitsuba 0.6");
        color *= 0.99 / largest;
    } else if (use == ColorUse::reflectance && largest > 1.0 && of_list) {
        diagnostics.warn(where, "the spectrum's colour exceeds 1 in a channel and was scaled down to it");
        color /= largest;
    }
    if (use == ColorUse::metal && std::min({color.x, color.y, color.z}) < 0.0) {
        // Fits may have negative values; Fresnel's equations depend on the squares of eta and k only.
        diagnostics.warn(where, "a metal's coefficient is negative: its sign has no influence");
        for (int i = 0; i < 3; ++i)
            color[i] = std::abs(color[i]);
    }
    const double limit = use == ColorUse::reflectance ? 1.0 : std::numeric_limits<float>::max();
    for (int i = 0; i < 3; ++i) {
        if (!(color[i] >= (use == ColorUse::factor ? -limit : 0.0)) || color[i] > limit)
            throw InputError(
                where,
                std::string(use == ColorUse::reflectance ? "a reflectance"
                            : use == ColorUse::radiance  ? "a radiance"
                                                         : "a coefficient") +
                    " of " + number_text(color[i]),
                use == ColorUse::reflectance ? "give values from 0 to 1" : "give finite values of 0 or more");
    }
    return Rgb(static_cast<float>(color.x), static_cast<float>(color.y), static_cast<float>(color.z));
}

Rgb read_color(const XmlElement& element, ColorUse use, Diagnostics& diagnostics) {
    Rgb64 color;
    bool of_list = false;
    if (element.tag == "spectrum" && element.find("filename")) {
        element.allow_attributes({"name", "filename"});
        color = color_of_list(read_spectrum_file(element.require("filename"), element.where), element, use);
        of_list = true;
    } else if (element.tag == "spectrum") {
        element.allow_attributes({"name", "value", "intent"});
        color = read_spectrum(element, use);
        of_list = element.require("value").find(':') != std::string::npos;
    } else if (element.tag == "blackbody") {
        if (use != ColorUse::radiance)
            throw InputError(element.where, "<blackbody> is light, not a property of a surface", "give an <rgb>");
        color = read_blackbody(element);
        of_list = true;
    } else {
        element.allow_attributes({"name", "value", "intent"});
        color = parse_triple(element);
        if (element.tag == "srgb")
            for (int i = 0; i < 3; ++i)
                color[i] = srgb_to_linear(color[i]);
    }
    return checked_color(color, of_list, element.version < 2, use, element.where, diagnostics);
}

}  // namespace treefarm::mitsuba
