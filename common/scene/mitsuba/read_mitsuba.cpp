#include "common/scene/mitsuba/read_mitsuba.h"

#include "common/scene/mitsuba/emitters.h"
#include "common/scene/mitsuba/integrator.h"
#include "common/scene/mitsuba/materials.h"
#include "common/scene/mitsuba/shape_reader.h"
#include "common/scene/remove_unused.h"
#include "common/scene/validate.h"

namespace treefarm {

SceneReading read_mitsuba_unchecked(const std::filesystem::path& path,
                                    const std::map<std::string, std::string>& defines, bool lenient,
                                    const mitsuba::FilmSize& film_size) {
    using namespace mitsuba;
    const SceneDocument document(path, defines);
    Diagnostics diagnostics(lenient);
    SceneReading reading;
    Scene& scene = reading.scene;

    Properties root(document.root(), document, diagnostics);
    const XmlElement* sensor = root.only_child("sensor");
    if (sensor == nullptr)
        throw InputError(document.root().where, "the scene has no sensor", "add <sensor type=\"perspective\">");
    read_sensor(*sensor, film_size, scene, reading.settings, document, diagnostics);
    // The budget of a guided integrator wins over the sampler's, which it ignores: it comes later.
    if (const XmlElement* integrator = root.only_child("integrator"))
        read_integrator(*integrator, reading.settings, document, diagnostics);

    MaterialReader materials(scene, document, diagnostics);
    // What is read where it is referred to.
    for (const char* tag : {"texture", "sampler", "film", "rfilter"})
        root.children(tag);
    for (const Child& bsdf : root.children("bsdf"))
        materials.read(*bsdf.object);
    ShapeReader shapes(scene, materials, document, diagnostics);
    for (const Child& shape : root.children("shape"))
        shapes.read(*shape.object);
    for (const Child& emitter : root.children("emitter"))
        read_emitter(*emitter.object, scene, materials.textures(), document, diagnostics);
    // How Mitsuba builds its hierarchy does not change the image.
    root.ignore_prefix("kd_");
    root.ignore({"allow_thread_reordering", "compact_acceleration_structures", "embree_use_robust_intersections"});
    root.finish();
    materials.textures().images().read(remove_unused(scene), scene, diagnostics);

    reading.warnings = std::move(diagnostics.warnings());
    return reading;
}

SceneReading read_mitsuba(const std::filesystem::path& path, const std::map<std::string, std::string>& defines,
                          bool lenient, const mitsuba::FilmSize& film_size) {
    SceneReading reading = read_mitsuba_unchecked(path, defines, lenient, film_size);
    std::vector<Warning> found;
    validate_scene(reading.scene, found);
    for (Warning& warning : found) {
        if (warning.where.file.empty()) warning.where.file = path.string();
        reading.warnings.push_back(std::move(warning));
    }
    return reading;
}

}  // namespace treefarm
