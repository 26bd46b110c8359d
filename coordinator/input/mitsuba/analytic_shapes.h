// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/model/shape.h"
#include "coordinator/input/mitsuba/properties.h"

namespace treefarm::mitsuba {

/// <shape type="sphere">: "center" and "radius", then "to_world", which may scale all axes alike. In version 0 a
/// mirroring transformation keeps the front outside, in versions 2 and 3 it turns the sphere inside out.
Sphere read_sphere(Properties& properties);

/// <shape type="disk">: the unit disk of the plane z = 0, front towards +z, under any "to_world".
Disk read_disk(Properties& properties);

/// <shape type="cylinder">: "p0", "p1" and "radius", then "to_world", which may scale the axis differently. In version
/// 0 a mirroring transformation turns the cylinder inside out, in versions 2 and 3 it keeps the front outside.
Cylinder read_cylinder(Properties& properties);

}  // namespace treefarm::mitsuba
