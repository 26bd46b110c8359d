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

/// A scene that has been read and checked.
struct LoadedScene {
    Scene scene;
    std::vector<Setting> settings;  ///< what its integrator and sampler ask of the job: the layer above the defaults
    std::vector<Warning> warnings;
    std::vector<Warning> notes;  ///< worth knowing, and no fault
};

/// Reads a scene file by its extension: .xml is Mitsuba's format. A width or height above 0 replaces the film's; the
/// camera's field of view follows the new shape of the film, as if the scene said so. `sensor` chooses one by its
/// number from 0 on or its id; "": the file's own choice. Bad input, and what is beyond the limits, throws InputError.
LoadedScene load_scene(const std::filesystem::path& path, const std::map<std::string, std::string>& defines = {},
                       bool lenient = false, int width = 0, int height = 0, const std::string& sensor = "",
                       const SceneLimits& limits = {});

/// A scene for lint(): before anything is repaired; what a render would refuse to read is left out.
struct SceneToCheck {
    Scene scene;
    std::vector<Setting> settings;  ///< as of LoadedScene
    std::vector<Finding> findings;  ///< what its reader has to say
};

/// Loads a scene for lint(). Throws InputError only if there is no scene to look at.
SceneToCheck load_scene_to_check(const std::filesystem::path& path,
                                 const std::map<std::string, std::string>& defines = {}, bool lenient = false,
                                 const std::string& sensor = "");

}  // namespace treefarm
