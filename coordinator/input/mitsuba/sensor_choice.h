// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "coordinator/input/mitsuba/properties.h"

namespace treefarm::mitsuba {

/// The sensor to render: the one with the id `wanted`, or with this number among all, from 0 on. If `wanted` is empty,
/// the first, or in files of version 0.x the last, as in Mitsuba, with a note if there are more. Throws InputError if
/// there is none.
const XmlElement& choose_sensor(Properties& scene, const std::string& wanted, Diagnostics& diagnostics);

}  // namespace treefarm::mitsuba
