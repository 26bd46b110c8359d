// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coordinator/input/mitsuba/properties.h"

namespace treefarm::mitsuba {

/// Half the width at distance 1 of what a camera or projector sees, from fov (degrees) and fov_axis or focal_length
/// (mm, of a film of 36 x 24 mm; 50 if nothing is said). `aspect`: width over height. InputError for what no camera
/// has.
double read_half_width(Properties& properties, double aspect);

}  // namespace treefarm::mitsuba
