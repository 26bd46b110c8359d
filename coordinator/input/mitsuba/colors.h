// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/math/vec.h"
#include "coordinator/input/colour/spectra.h"
#include "coordinator/input/mitsuba/diagnostics.h"
#include "coordinator/input/mitsuba/xml_document.h"

namespace treefarm::mitsuba {

/// Use of a colour: it decides how spectra become Rgb.
enum class ColorUse {
    reflectance,  ///< in [0, 1]
    coefficient,  ///< a property of a surface without an upper limit
    metal,        ///< eta or k of a conductor
    factor,       ///< on displacements, of any sign
    radiance      ///< of something that shines
};

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
