#include "common/scene/load.h"

#include "common/config/parse_text.h"
#include "common/scene/mitsuba/read_mitsuba.h"

namespace treefarm {

LoadedScene load_scene(const std::filesystem::path& path, const std::map<std::string, std::string>& defines,
                       bool lenient, int width, int height) {
    if (path.extension() != ".xml") {
        const std::string extension = path.extension().string();
        throw InputError({path.string()},
                         extension.empty() ? "the scene file has no extension"
                                           : "scenes of kind " + in_quotes(extension) + " cannot be read",
                         "give a Mitsuba scene (.xml)");
    }
    SceneReading reading = read_mitsuba(path, defines, lenient, {width, height});
    return {std::move(reading.scene), std::move(reading.settings), std::move(reading.warnings)};
}

}  // namespace treefarm
