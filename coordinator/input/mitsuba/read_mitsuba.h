// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "common/config/setting.h"
#include "common/scene/model/scene.h"
#include "coordinator/input/check/finding.h"
#include "coordinator/input/check/scene_limits.h"
#include "coordinator/input/check/warning.h"
#include "coordinator/input/mitsuba/sensor.h"

namespace treefarm {

/// Result of reading a scene file.
struct SceneReading {
    Scene scene;
    std::vector<Setting> settings;  ///< job settings from its integrator and sampler
    std::vector<Warning> warnings;
    std::vector<Warning> notes;     ///< remarks that are no faults
    std::vector<Finding> findings;  ///< when checking: warnings, faults and remarks
};

/// Reads a Mitsuba scene (versions 0.5, 0.6, 2 and 3 of the format). `defines`: values for $name. Features that cannot
/// be rendered throw InputError, or are skipped or approximated with a warning when `lenient`; malformed input always
/// throws. `shift`: added to every position in the world before it becomes a float. `sensor`: as in choose_sensor().
SceneReading read_mitsuba(const std::filesystem::path& path, const std::map<std::string, std::string>& defines,
                          bool lenient, const Imath::V3d& shift, const mitsuba::FilmSize& film_size = {},
                          const std::string& sensor = "", const SceneLimits& limits = {});

/// Reads a Mitsuba scene for lint(): faulty parts become findings and are left out. Throws InputError only if there is
/// no scene to examine: bad XML, no sensor.
SceneReading read_mitsuba_to_check(const std::filesystem::path& path, const std::map<std::string, std::string>& defines,
                                   bool lenient, const std::string& sensor = "");

}  // namespace treefarm
