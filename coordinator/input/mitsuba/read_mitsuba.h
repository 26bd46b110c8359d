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
    std::vector<Setting> settings;  ///< what its integrator and sampler ask of the job
    std::vector<Warning> warnings;
    std::vector<Warning> notes;     ///< worth knowing, and no fault
    std::vector<Finding> findings;  ///< when checked: warnings, what was refused and left out, remarks
};

/// Reads a Mitsuba scene (versions 0.5, 0.6, 2 and 3 of the format). `defines` are values for $name. What cannot be
/// rendered throws InputError, or is skipped or approximated with a warning when `lenient`; malformed input always
/// throws. `shift` is added to every position in the world before it becomes a float. `sensor`: as in choose_sensor().
SceneReading read_mitsuba(const std::filesystem::path& path, const std::map<std::string, std::string>& defines,
                          bool lenient, const Imath::V3d& shift, const mitsuba::FilmSize& film_size = {},
                          const std::string& sensor = "", const SceneLimits& limits = {});

/// Reads a Mitsuba scene for lint(): parts that are refused are findings, and left out. Throws InputError only if there
/// is no scene to look at: bad XML, no sensor.
SceneReading read_mitsuba_to_check(const std::filesystem::path& path, const std::map<std::string, std::string>& defines,
                                   bool lenient, const std::string& sensor = "");

}  // namespace treefarm
