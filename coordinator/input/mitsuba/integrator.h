// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/config/setting.h"
#include "coordinator/input/mitsuba/properties.h"

namespace treefarm::mitsuba {

/// Turns <integrator type="path">, integrators that converge to its image, <integrator type="guided_path"> and others
/// that the program has into settings of the job. Unknown ones throw InputError or, when lenient, only set their common
/// properties.
void read_integrator(const XmlElement& integrator, std::vector<Setting>& settings, const SceneDocument& document,
                     Diagnostics& diagnostics);

}  // namespace treefarm::mitsuba
