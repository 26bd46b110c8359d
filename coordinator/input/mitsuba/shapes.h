// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/scene/model/scene.h"
#include "coordinator/input/mitsuba/properties.h"

namespace treefarm::mitsuba {

/// The geometry of a shape element in world space: a mesh or an analytic shape. Fronts are where the version of
/// Mitsuba has them that the file is written for. Other shapes throw InputError, or give nothing when lenient.
std::optional<decltype(Shape::geometry)> read_geometry(Properties& properties, Diagnostics& diagnostics);

}  // namespace treefarm::mitsuba
