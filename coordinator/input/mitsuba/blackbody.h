// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coordinator/input/mitsuba/colors.h"
#include "coordinator/input/mitsuba/xml_document.h"

namespace treefarm::mitsuba {

/// Colour of a black body (Planck's law), linear Rec. 709, W / (m^2 sr nm) as in Mitsuba 0.6; channels can be negative.
/// `temperature`: kelvin, above 0 and at most 1e6, otherwise InputError at `where`.
Imath::Color3<double> blackbody_color(double temperature, const Location& where);

/// Colour of <blackbody name="..." temperature="5000K" scale="1"/>. Wrong attributes and temperatures throw InputError.
Imath::Color3<double> read_blackbody(const XmlElement& element);

}  // namespace treefarm::mitsuba
