// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coordinator/input/mitsuba/properties.h"

namespace treefarm::mitsuba {

/// Half the width at distance 1 of the view of a camera or projector, from fov (degrees) and fov_axis, or focal_length
/// (mm, for a film of 36 x 24 mm; default 50). `aspect`: width over height. Throws InputError for impossible values.
double read_half_width(Properties& properties, double aspect);

}  // namespace treefarm::mitsuba
