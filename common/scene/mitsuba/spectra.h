// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "common/math/vec.h"
#include "common/scene/mitsuba/diagnostics.h"
#include "common/scene/mitsuba/xml_document.h"

namespace treefarm::mitsuba {

/// Use of a colour: it decides how spectra become Rgb.
enum class ColorUse {
    reflectance,  ///< in [0, 1]
    coefficient,  ///< a property of a surface without an upper limit
    metal,        ///< eta or k of a conductor
    factor,       ///< on displacements, of any sign
    radiance      ///< of something that shines
};

/// (wavelength in nm, value), wavelengths rising: a piecewise linear spectrum, 0 outside.
using SpectrumSamples = std::vector<std::pair<double, double>>;

/// Linear Rec. 709 of a spectrum, seen by the CIE 1931 observer and divided by the integral of ybar, so that a spectrum
/// that is 1 everywhere has Y = 1. Channels can be negative. With `under_d65` the spectrum is a reflectance, lit by
/// D65: the white one is (1, 1, 1) then.
Imath::Color3<double> spectrum_to_rgb(const SpectrumSamples& samples, bool under_d65);

/// CIE XYZ to linear Rec. 709; channels can be negative.
Imath::Color3<double> xyz_to_rgb(double x, double y, double z);

/// Linear value of an sRGB channel.
double srgb_to_linear(double encoded);

/// Colour of a list of wavelengths, as the version of Mitsuba that the element is written for computes it when it
/// renders in RGB. Channels can be negative.
Imath::Color3<double> color_of_list(const SpectrumSamples& samples, const XmlElement& element, ColorUse use);

/// The colour if its use allows it, otherwise InputError. That of a list is bounded first: the eye's response to a few
/// wavelengths lies outside Rec. 709. So is a reflectance of an old file (before version 2): Mitsuba 0.6 scales one
/// that exceeds 1 in a channel down to 0.99 (BSDF::ensureEnergyConservation).
Rgb checked_color(Imath::Color3<double> color, bool of_list, bool is_old, ColorUse use, const Location& where,
                  Diagnostics& diagnostics);

/// The colour of an <rgb>, <srgb>, <spectrum> (value or file) or <blackbody> element, not negative.
Rgb read_color(const XmlElement& element, ColorUse use, Diagnostics& diagnostics);

}  // namespace treefarm::mitsuba
