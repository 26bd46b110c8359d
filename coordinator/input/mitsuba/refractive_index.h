// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "coordinator/input/mitsuba/properties.h"

namespace treefarm::mitsuba {

/// Index of refraction from a property with a number or the name of a substance ("water", "bk7"...).
double read_refractive_index(Properties& properties, const std::string& name, const std::string& otherwise);

/// Relative index of refraction intIOR / extIOR, above 0.
float read_relative_index(Properties& properties, const std::string& inside_otherwise);

}  // namespace treefarm::mitsuba
