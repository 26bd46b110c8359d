#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "common/config/setting.h"
#include "common/scene/scene.h"
#include "common/scene/warning.h"

namespace treefarm {

/// A scene that has been read and checked.
struct LoadedScene {
    Scene scene;
    std::vector<Setting> settings;  ///< what its integrator and sampler ask of the job: the layer above the defaults
    std::vector<Warning> warnings;
};

/// Reads a scene file by its extension: .xml is Mitsuba's format. A width or height above 0 replaces the film's; the
/// camera's field of view follows the new shape of the film, as if the scene said so. Bad input throws InputError.
LoadedScene load_scene(const std::filesystem::path& path, const std::map<std::string, std::string>& defines = {},
                       bool lenient = false, int width = 0, int height = 0);

/// The same for inspect(): as the file has it, before anything is checked, repaired or left out.
LoadedScene load_scene_unchecked(const std::filesystem::path& path,
                                 const std::map<std::string, std::string>& defines = {}, bool lenient = false);

}  // namespace treefarm
