// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/load.h"

#include "common/base/text/parse_text.h"
#include "coordinator/input/check/validate.h"
#include "coordinator/input/foreign_format.h"
#include "coordinator/input/mitsuba/read_mitsuba.h"

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

/// Distance from the origin, in sizes of the scene, at which its floats lose 6 of their 24 bits.
constexpr double kFarSizes = 64.0;

/// Shift that moves a distant scene to the origin; 0 for one that is near, or is not finite.
Imath::V3d shift_of(const Scene& scene) {
    Box3 box;
    for (const Shape& shape : scene.shapes)
        if (shape.group == kNone) box.extendBy(own_box(shape));
    if (box.isEmpty() || !is_finite(box.min) || !is_finite(box.max)) return Imath::V3d(0.0);
    const Imath::V3d low(box.min), high(box.max), middle = (low + high) * 0.5, size = high - low;
    const double largest = std::max(size.x, std::max(size.y, size.z));
    return middle.length() > kFarSizes * largest && largest > 0 ? -middle : Imath::V3d(0.0);
}

}  // namespace

LoadedScene load_scene(const std::filesystem::path& path, const std::map<std::string, std::string>& defines,
                       bool lenient, int width, int height, const std::string& sensor, const SceneLimits& limits) {
    require_xml(path);
    const auto read = [&](const Imath::V3d& shift) {
        return read_mitsuba(path, defines, lenient, shift, {width, height}, sensor, limits);
    };
    SceneReading reading = read(Imath::V3d(0.0));
    // The image does not depend on the scene's position, but its precision does: a distant scene is read again,
    // shifted.
    if (const Imath::V3d shift = shift_of(reading.scene); shift != Imath::V3d(0.0)) reading = read(shift);
    std::vector<Warning> found;
    validate_scene(reading.scene, found);
    for (Warning& warning : found) {
        if (warning.where.file.empty()) warning.where.file = path.string();
        reading.warnings.push_back(std::move(warning));
    }
    return {std::move(reading.scene), std::move(reading.settings), std::move(reading.warnings),
            std::move(reading.notes)};
}

SceneToCheck load_scene_to_check(const std::filesystem::path& path, const std::map<std::string, std::string>& defines,
                                 bool lenient, const std::string& sensor) {
    require_xml(path);
    SceneReading reading = read_mitsuba_to_check(path, defines, lenient, sensor);
    return {std::move(reading.scene), std::move(reading.settings), std::move(reading.findings)};
}

}  // namespace treefarm
