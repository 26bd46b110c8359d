// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/math/vec.h"

namespace treefarm {

/// Time and position of an observer of the sky.
struct Observation {
    int year = 2010, month = 7, day = 10;
    double hour = 15.0, minute = 0.0, second = 0.0;   ///< local time
    double latitude = 35.6894, longitude = 139.6917;  ///< degrees, north and east positive
    double timezone = 9.0;                            ///< hours ahead of universal time
};

/// A direction in the sky, radians.
struct SkyAngles {
    double zenith = 0.0;   ///< angle from straight up
    double azimuth = 0.0;  ///< angle from north over east
};

/// Position of the sun, as in Mitsuba 0.6's sunmodel.h (computeSunCoordinates), which names Blanco-Muriel et al. 2001
/// as its source; accurate to half a minute of arc according to Mitsuba's documentation.
SkyAngles sun_position(const Observation& observation);

/// Radiance of the sun's disk in linear Rec. 709, W / (m^2 sr nm), through air of this turbidity: Preetham, Shirley and
/// Smits 1999 (A practical analytic model for daylight), as in Mitsuba 0.6's sunmodel.h (computeSunRadiance). The sun
/// must be above the horizon.
Imath::Color3<double> preetham_sun(double turbidity, double sun_zenith);

/// Angular radius of the sun, radians (0.5358 degrees across, as in Mitsuba).
inline constexpr double kSunRadius = 0.5358 / 2.0 * M_PI / 180.0;

}  // namespace treefarm
