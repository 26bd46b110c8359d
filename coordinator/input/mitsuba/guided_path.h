// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coordinator/input/mitsuba/integrator_settings.h"

namespace treefarm::mitsuba {

/// Turns <integrator type="guided_path"> (the plugin of Mueller et al., 2017 to 2019) into settings of the job: the
/// preset paper, overridden by the element's properties.
void read_guided_path(IntegratorSettings& settings);

}  // namespace treefarm::mitsuba
