// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "coordinator/input/mitsuba/properties.h"

namespace treefarm::mitsuba {

/// The sensor that a scene is seen by: the one that `wanted` names by its id, or by its number among all of them from 0
/// on. If nothing is wanted, the first, or in files of version 0.x the last, as Mitsuba does, with a note if there are
/// more. Throws InputError if there is none.
const XmlElement& choose_sensor(Properties& scene, const std::string& wanted, Diagnostics& diagnostics);

}  // namespace treefarm::mitsuba
