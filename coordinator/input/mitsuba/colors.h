// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "common/base/error.h"
#include "common/math/vec.h"
#include "coordinator/input/colour/spectra.h"
#include "coordinator/input/mitsuba/diagnostics.h"
#include "coordinator/input/mitsuba/xml_document.h"

namespace treefarm::mitsuba {

/// Use of a colour, which decides how spectra become Rgb.
enum class ColorUse {
    reflectance,  ///< a factor in [0, 1]
    coefficient,  ///< a property of a surface without upper limit
    metal,        ///< eta or k of a conductor
    factor,       ///< factor on displacements, of any sign
    radiance      ///< radiance of an emitter
};

/// Colour of a list of wavelengths, as computed by the version of Mitsuba that the element is written for, in RGB mode.
/// Channels can be negative.
Imath::Color3<double> color_of_list(const SpectrumSamples& samples, const XmlElement& element, ColorUse use);

/// The colour if its use allows it; otherwise throws InputError. The colour of a list is clamped first, since the eye's
/// response to a few wavelengths is outside Rec. 709. A reflectance in a file before version 2 that exceeds 1 in a
/// channel is scaled to 0.99, as in Mitsuba 0.6 (BSDF::ensureEnergyConservation).
Rgb checked_color(Imath::Color3<double> color, bool of_list, bool is_old, ColorUse use, const Location& where,
                  Diagnostics& diagnostics);

/// Colour of an <rgb>, <srgb>, <spectrum> (value or file) or <blackbody> element, not negative.
Rgb read_color(const XmlElement& element, ColorUse use, Diagnostics& diagnostics);

/// Colour of a black body (Planck's law), linear Rec. 709, W / (m^2 sr nm) as in Mitsuba 0.6; channels can be negative.
/// `temperature`: kelvin, above 0 and at most 1e6, otherwise InputError at `where`.
Imath::Color3<double> blackbody_color(double temperature, const Location& where);

/// Colour of <blackbody name="..." temperature="5000K" scale="1"/>. Wrong attributes and temperatures throw InputError.
Imath::Color3<double> read_blackbody(const XmlElement& element);

/// Spectrum from a file of "wavelength value" per line, with # before comments (.spd). Throws InputError if the file is
/// missing, has more than 100,000 lines, a malformed line, wavelengths that do not increase, or fewer than two.
SpectrumSamples read_spectrum_file(const std::filesystem::path& path, const Location& asked_from);

}  // namespace treefarm::mitsuba
