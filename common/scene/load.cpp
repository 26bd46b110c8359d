// SPDX-License-Identifier: Apache-2.0
#include "common/scene/load.h"

#include "common/config/parse_text.h"
#include "common/scene/foreign_format.h"
#include "common/scene/mitsuba/read_mitsuba.h"

namespace treefarm {

namespace {

void require_xml(const std::filesystem::path& path) {
    if (path.extension() == ".xml") return;
    const std::string extension = path.extension().string();
    throw InputError({path.string()},
                     extension.empty() ? "the scene file has no extension"
                                       : "scenes of kind " + in_quotes(extension) + " cannot be read",
                     foreign_format_cure(extension));
}

LoadedScene loaded(SceneReading&& reading) {
    return {std::move(reading.scene), std::move(reading.settings), std::move(reading.warnings),
            std::move(reading.notes)};
}

}  // namespace

LoadedScene load_scene(const std::filesystem::path& path, const std::map<std::string, std::string>& defines,
                       bool lenient, int width, int height, const std::string& sensor) {
    require_xml(path);
    return loaded(read_mitsuba(path, defines, lenient, {width, height}, sensor));
}

SceneToCheck load_scene_to_check(const std::filesystem::path& path, const std::map<std::string, std::string>& defines,
                                 bool lenient, const std::string& sensor) {
    require_xml(path);
    SceneReading reading = read_mitsuba_to_check(path, defines, lenient, sensor);
    return {std::move(reading.scene), std::move(reading.settings), std::move(reading.findings)};
}

}  // namespace treefarm
