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

namespace treefarm {

/// A scene that was read and checked.
struct LoadedScene {
    Scene scene;
    std::vector<Setting> settings;  ///< job settings from its integrator and sampler: the layer above the defaults
    std::vector<Warning> warnings;
    std::vector<Warning> notes;  ///< remarks that are no faults
};

/// Reads a scene file by its extension: .xml is Mitsuba's format. A width or height above 0 replaces the film's; the
/// camera's field of view adapts to the new aspect ratio, as if the scene had it. `sensor`: number from 0 on, or id;
/// "": the file's default. Throws InputError for bad input and input beyond the limits.
LoadedScene load_scene(const std::filesystem::path& path, const std::map<std::string, std::string>& defines = {},
                       bool lenient = false, int width = 0, int height = 0, const std::string& sensor = "",
                       const SceneLimits& limits = {});

/// A scene for lint(), before any repair; parts that a render would refuse are left out.
struct SceneToCheck {
    Scene scene;
    std::vector<Setting> settings;  ///< as in LoadedScene
    std::vector<Finding> findings;  ///< findings of its reader
};

/// Loads a scene for lint(). Throws InputError only if there is no scene to examine.
SceneToCheck load_scene_to_check(const std::filesystem::path& path,
                                 const std::map<std::string, std::string>& defines = {}, bool lenient = false,
                                 const std::string& sensor = "");

}  // namespace treefarm
