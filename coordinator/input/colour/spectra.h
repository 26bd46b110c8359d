// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include "common/math/vec.h"

namespace treefarm {

/// Piecewise linear spectrum: (wavelength in nm, value) with increasing wavelengths; 0 outside.
using SpectrumSamples = std::vector<std::pair<double, double>>;

/// Linear Rec. 709 of a spectrum, seen by the CIE 1931 observer and divided by the integral of ybar, so that a spectrum
/// of 1 has Y = 1. Channels can be negative. With `under_d65` the spectrum is a reflectance lit by D65: white is (1, 1,
/// 1).
Imath::Color3<double> spectrum_to_rgb(const SpectrumSamples& samples, bool under_d65);

/// CIE XYZ converted to linear Rec. 709; channels can be negative.
Imath::Color3<double> xyz_to_rgb(double x, double y, double z);

/// Linear value of an sRGB channel.
double srgb_to_linear(double encoded);

}  // namespace treefarm
