// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "common/math/vec.h"

namespace treefarm {

/// Clear sky of Hosek and Wilkie 2012 (An analytic model for full spectral sky-dome radiance, ACM Transactions on
/// Graphics 31, 4), in the authors' version for linear Rec. 709.
class HosekWilkieSky {
  public:
    /// Turbidity from 1 to 10; albedo of the ground from 0 to 1 in each channel; elevation of the sun in radians from 0
    /// (the horizon) to pi / 2.
    HosekWilkieSky(double turbidity, const Imath::Color3<double>& albedo, double sun_elevation);

    /// Radiance from a direction `zenith` radians from straight up (at most pi / 2) and `from_sun` radians from the
    /// centre of the sun, W / (m^2 sr), weighted with the matching functions. Divided by the integral of ybar (106.857
    /// nm) it is the radiance per nm of a light that is equal at all wavelengths. Negative values of the fit become 0.
    Imath::Color3<double> radiance(double zenith, double from_sun) const;

  private:
    /// The paper's A to I in the authors' order, then the mean radiance.
    using Coefficients = std::array<double, 10>;

    std::array<Coefficients, 3> channels_;
};

/// Irradiance of the sun on a plane perpendicular to it, linear Rec. 709, W / (m^2 nm), by the same authors' solar
/// radiance function (Adding a solar-radiance function to the Hosek-Wilkie skylight model, IEEE Computer Graphics and
/// Applications 33, 3, 2013) as Mitsuba 3 integrates and interpolates it. Turbidity from 1 to 10; elevation in radians,
/// clamped to 2 to 89 degrees. Not negative.
Imath::Color3<double> hosek_wilkie_sun(double turbidity, double sun_elevation);

}  // namespace treefarm
