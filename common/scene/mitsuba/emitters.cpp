#include "common/scene/mitsuba/emitters.h"

#include "common/config/parse_text.h"

namespace treefarm::mitsuba {
namespace {

/// How often emitters are chosen does not change the image.
void ignore_sampling(Properties& properties) {
    properties.ignore({"sampling_weight"});
}

}  // namespace

void read_area_emitter(const XmlElement& emitter, std::int32_t shape, Scene& scene, const SceneDocument& document,
                       Diagnostics& diagnostics) {
    Properties properties(emitter, document, diagnostics);
    if (properties.type() != "area") {
        diagnostics.unsupported(emitter.where, properties.title() + " in a shape is not available in this version",
                                "use <emitter type=\"area\">");
        return;
    }
    if (properties.has("to_world"))
        throw InputError(properties.where("to_world"), "an area emitter has a transformation of its own",
                         "give it to the shape");
    const Rgb radiance = properties.color("radiance", Rgb(1.0f), ColorUse::radiance);
    ignore_sampling(properties);
    properties.finish();
    scene.shapes[static_cast<std::size_t>(shape)].emitter = static_cast<std::int32_t>(scene.emitters.size());
    scene.emitters.push_back({AreaEmitter{radiance, shape}, emitter.where});
}

void read_environment(const XmlElement& emitter, Scene& scene, const SceneDocument& document,
                      Diagnostics& diagnostics) {
    Properties properties(emitter, document, diagnostics);
    if (properties.type() != "constant") {
        diagnostics.unsupported(emitter.where, properties.title() + " is not available in this version",
                                "use area emitters in shapes, or <emitter type=\"constant\">");
        return;
    }
    const Rgb radiance = properties.color("radiance", Rgb(1.0f), ColorUse::radiance);
    // A constant looks the same from all sides.
    properties.ignore({"to_world"});
    ignore_sampling(properties);
    properties.finish();
    if (scene.environment() != kNone)
        throw InputError(emitter.where, "this is a second environment emitter", "keep one of them");
    scene.emitters.push_back({ConstantEmitter{radiance}, emitter.where});
}

}  // namespace treefarm::mitsuba
