// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/scene/model/scene.h"
#include "coordinator/input/mitsuba/properties.h"

namespace treefarm::mitsuba {

/// Geometry of a shape element in world space: a mesh or an analytic shape. Fronts are those of the version of Mitsuba
/// that the file is written for. Other shapes throw InputError, or give nothing when lenient.
std::optional<decltype(Shape::geometry)> read_geometry(Properties& properties, Diagnostics& diagnostics);

}  // namespace treefarm::mitsuba
