// SPDX-License-Identifier: Apache-2.0
#include "common/scene/mitsuba/read_mitsuba.h"

#include <set>

#include "common/scene/mitsuba/emitters.h"
#include "common/scene/mitsuba/integrator.h"
#include "common/scene/mitsuba/materials.h"
#include "common/scene/mitsuba/reachable.h"
#include "common/scene/mitsuba/sensor_choice.h"
#include "common/scene/mitsuba/shape_reader.h"
#include "common/scene/remove_unused.h"
#include "common/scene/validate.h"

namespace treefarm {

namespace {

using namespace mitsuba;

SceneReading read(const SceneDocument& document, Diagnostics diagnostics, const FilmSize& film_size,
                  const std::string& wanted_sensor, const Imath::V3d& shift) {
    diagnostics.world_shift = shift;
    SceneReading reading;
    Scene& scene = reading.scene;

    Properties root(document.root(), document, diagnostics);
    const XmlElement& sensor = choose_sensor(root, wanted_sensor, diagnostics);
    diagnostics.attempt([&] { read_sensor(sensor, film_size, scene, reading.settings, document, diagnostics); });
    // The budget of a guided integrator wins over the sampler's, which it ignores: it comes later.
    if (const XmlElement* integrator = root.only_child("integrator"))
        diagnostics.attempt([&] { read_integrator(*integrator, reading.settings, document, diagnostics); });

    const std::set<const XmlElement*> reachable = reachable_objects(document);
    const auto is_used = [&](const Child& child) {
        if (reachable.contains(child.object)) return true;
        diagnostics.find({Finding::Severity::note, "reader", child.where,
                          "nothing refers to this <" + child.object->tag + ">: it is not read", ""});
        return false;
    };
    MaterialReader materials(scene, document, diagnostics);
    // What is read where it is referred to.
    for (const char* tag : {"texture", "sampler", "film", "rfilter", "subsurface", "medium", "phase", "volume"})
        root.children(tag);
    for (const Child& bsdf : root.children("bsdf"))
        if (is_used(bsdf)) diagnostics.attempt([&] { materials.read(*bsdf.object); });
    ShapeReader shapes(scene, materials, document, diagnostics);
    for (const Child& shape : root.children("shape"))
        if (is_used(shape)) diagnostics.attempt([&] { shapes.read(*shape.object); });
    for (const Child& emitter : root.children("emitter"))
        diagnostics.attempt([&] { read_emitter(*emitter.object, scene, materials.textures(), document, diagnostics); });
    // How Mitsuba builds its hierarchy does not change the image.
    root.ignore_prefix("kd_");
    root.ignore({"allow_thread_reordering", "compact_acceleration_structures"});
    if (const char* robust = "embree_use_robust_intersections"; root.has(robust))
        reading.settings.push_back({"farm.robust", root.boolean(robust, false) ? "true" : "false", root.where(robust)});
    diagnostics.attempt([&] { root.finish(); });
    materials.textures().images().read(remove_unused(scene), scene, diagnostics);

    reading.warnings = std::move(diagnostics.warnings());
    reading.notes = std::move(diagnostics.notes());
    reading.findings = std::move(diagnostics.findings());
    return reading;
}

/// So many of its own sizes from the origin, a scene loses 6 of the 24 bits of its floats.
constexpr double kFarSizes = 64.0;

/// The shift that moves a far scene to the origin; 0 for one that is near, or is not finite.
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

SceneReading read_mitsuba_to_check(const std::filesystem::path& path, const std::map<std::string, std::string>& defines,
                                   bool lenient, const std::string& sensor) {
    return read(SceneDocument(path, defines), Diagnostics(lenient, true), {}, sensor, Imath::V3d(0.0));
}

SceneReading read_mitsuba(const std::filesystem::path& path, const std::map<std::string, std::string>& defines,
                          bool lenient, const mitsuba::FilmSize& film_size, const std::string& sensor) {
    const SceneDocument document(path, defines);
    SceneReading reading = read(document, Diagnostics(lenient), film_size, sensor, Imath::V3d(0.0));
    // The image does not depend on where a scene stands, but its digits do: far from the origin it is read again.
    if (const Imath::V3d shift = shift_of(reading.scene); shift != Imath::V3d(0.0))
        reading = read(document, Diagnostics(lenient), film_size, sensor, shift);
    std::vector<Warning> found;
    validate_scene(reading.scene, found);
    for (Warning& warning : found) {
        if (warning.where.file.empty()) warning.where.file = path.string();
        reading.warnings.push_back(std::move(warning));
    }
    return reading;
}

}  // namespace treefarm
