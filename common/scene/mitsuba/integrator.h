#pragma once

#include <vector>

#include "common/config/setting.h"
#include "common/scene/mitsuba/properties.h"

namespace treefarm::mitsuba {

/// Turns <integrator type="path"> and <integrator type="guided_path"> (the plugin of Mueller et al. 2017) into settings
/// of the job. Others throw InputError, or say nothing when lenient.
void read_integrator(const XmlElement& integrator, std::vector<Setting>& settings, const SceneDocument& document,
                     Diagnostics& diagnostics);

}  // namespace treefarm::mitsuba
