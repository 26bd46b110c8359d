// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/mitsuba/read_mitsuba.h"

#include <algorithm>
#include <set>

#include "common/scene/uses/remove_unused.h"
#include "coordinator/input/mitsuba/emitters.h"
#include "coordinator/input/mitsuba/integrator.h"
#include "coordinator/input/mitsuba/materials.h"
#include "coordinator/input/mitsuba/scene_document.h"
#include "coordinator/input/mitsuba/sensor.h"
#include "coordinator/input/mitsuba/shape_reader.h"

namespace treefarm {

namespace {

using namespace mitsuba;

/// Whether an element has an emitter in it, read or not.
bool has_emitters(const XmlElement& element) {
    return element.tag == "emitter" || std::any_of(element.children.begin(), element.children.end(), has_emitters);
}

SceneReading read(const SceneDocument& document, Diagnostics diagnostics, const FilmSize& film_size,
                  const std::string& wanted_sensor, const Imath::V3d& shift) {
    diagnostics.world_shift = shift;
    SceneReading reading;
    Scene& scene = reading.scene;

    Properties root(document.root(), document, diagnostics);
    const XmlElement* const sensor = choose_sensor(root, wanted_sensor, diagnostics);
    const int version = document.root().version;
    diagnostics.attempt([&] {
        if (sensor)
            read_sensor(*sensor, film_size, scene, reading.settings, document, diagnostics);
        else
            scene.film = read_film(nullptr, film_size, version, reading.settings, document, diagnostics);
    });
    // The budget of a guided integrator overrides the sampler's, which it ignores: it comes later.
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
    // Objects that are read where they are referred to.
    for (const char* tag : {"texture", "sampler", "film", "rfilter", "subsurface", "medium", "phase", "volume"})
        root.children(tag);
    for (const Child& bsdf : root.children("bsdf"))
        if (is_used(bsdf)) diagnostics.attempt([&] { materials.read(*bsdf.object); });
    ShapeReader shapes(scene, materials, document, diagnostics);
    for (const Child& shape : root.children("shape"))
        if (is_used(shape)) diagnostics.attempt([&] { shapes.read(*shape.object); });
    for (const Child& emitter : root.children("emitter"))
        diagnostics.attempt([&] { read_emitter(*emitter.object, scene, materials.textures(), document, diagnostics); });
    if (!sensor) set_default_camera(version, scene);
    if (version < 2 && scene.emitters.empty() && !has_emitters(document.root()))
        diagnostics.attempt([&] { add_default_sky(document, scene, materials.textures(), diagnostics); });
    // Options of Mitsuba's hierarchy do not change the image.
    root.ignore_prefix("kd_");
    root.ignore({"allow_thread_reordering", "compact_acceleration_structures"});
    if (const char* robust = "embree_use_robust_intersections"; root.has(robust))
        reading.settings.push_back({"farm.robust", root.boolean(robust, false) ? "true" : "false", root.where(robust)});
    diagnostics.attempt([&] { root.finish(); });
    choose_line_widths(scene);
    materials.textures().images().read(remove_unused(scene), scene, diagnostics);

    reading.warnings = std::move(diagnostics.warnings());
    reading.notes = std::move(diagnostics.notes());
    reading.findings = std::move(diagnostics.findings());
    return reading;
}

}  // namespace

SceneReading read_mitsuba_to_check(const std::filesystem::path& path, const std::map<std::string, std::string>& defines,
                                   bool lenient, const std::string& sensor) {
    return read(SceneDocument(path, defines), Diagnostics(lenient, true), {}, sensor, Imath::V3d(0.0));
}

SceneReading read_mitsuba(const std::filesystem::path& path, const std::map<std::string, std::string>& defines,
                          bool lenient, const Imath::V3d& shift, const mitsuba::FilmSize& film_size,
                          const std::string& sensor, const SceneLimits& limits) {
    return read(SceneDocument(path, defines, limits), Diagnostics(lenient, false, limits), film_size, sensor, shift);
}

}  // namespace treefarm
