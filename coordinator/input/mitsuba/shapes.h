// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/scene/model/scene.h"
#include "common/scene/model/shape.h"
#include "coordinator/input/mitsuba/properties.h"

namespace treefarm::mitsuba {

/// Geometry of a shape element in world space: a mesh or an analytic shape. Fronts are those of the version of Mitsuba
/// that the file is written for. Other shapes throw InputError, or give nothing when lenient.
std::optional<decltype(Shape::geometry)> read_geometry(Properties& properties, Diagnostics& diagnostics);

/// Reads <shape type="sphere">: "center" and "radius", then "to_world", with a uniform scale. With a mirroring
/// transformation version 0 keeps the front outside; versions 2 and 3 turn the sphere inside out.
Sphere read_sphere(Properties& properties);

/// Reads <shape type="disk">: the unit disk of the plane z = 0, front towards +z, under any "to_world".
Disk read_disk(Properties& properties);

/// Reads <shape type="cylinder">: "p0", "p1" and "radius", then "to_world", which may scale the axis differently. With
/// a mirroring transformation version 0 turns the cylinder inside out; versions 2 and 3 keep the front outside.
Cylinder read_cylinder(Properties& properties);

}  // namespace treefarm::mitsuba
