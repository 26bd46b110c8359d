// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/mitsuba/emitters.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "common/base/text/parse_text.h"
#include "coordinator/input/mitsuba/field_of_view.h"

namespace treefarm::mitsuba {
namespace {

/// Ignores the sampling weight, which does not change the image.
void ignore_sampling(Properties& properties) {
    properties.ignore({"sampling_weight", "mis_compensation"});
}

float radians(double degrees) {
    return static_cast<float>(degrees * M_PI / 180.0);
}

Vec3 z_axis(const Matrix& to_world) {
    return normalize(transform_vector(to_world, Vec3(0.0f, 0.0f, 1.0f)));
}

EmitterKind read_point(Properties& properties, TextureReader& textures, const Diagnostics& diagnostics) {
    PointEmitter point;
    if (properties.has("position") && properties.has("to_world"))
        throw InputError(properties.where("position"), "both a position and a transformation are given", "keep one");
    point.position = properties.has("position")
                         ? Vec3(Imath::V3d(properties.point("position", point.position)) + diagnostics.world_shift)
                         : transform_point(properties.transform("to_world"), Vec3(0.0f));
    point.intensity = textures.constant(properties, "intensity", Rgb(1.0f), ColorUse::radiance);
    return point;
}

/// Reads the texture that a spot projects, in the frame of its transformation. A constant texture has no effect in
/// Mitsuba 0.6, and is not allowed in 3.
void read_projection(Properties& properties, const Matrix& to_world, SpotEmitter& spot, TextureReader& textures) {
    const XmlElement* texture = properties.named_child("texture", "texture");
    if (texture == nullptr) return properties.ignore({"texture"});
    const ColorInput projected = textures.color(properties, "texture", Rgb(1.0f), ColorUse::radiance);
    if (!projected.varies()) return;
    if (!(uniform_scale(to_world, 1e-3) > 0.0))
        throw InputError(properties.where("to_world"), "the transformation of a spot with a texture contains a shear",
                         "only rotate, mirror, move it and scale it alike in all directions");
    spot.intensity *= projected.value;
    spot.texture = projected.texture;
    spot.x_axis = normalize(transform_vector(to_world, Vec3(1.0f, 0.0f, 0.0f)));
    spot.y_axis = normalize(transform_vector(to_world, Vec3(0.0f, 1.0f, 0.0f)));
}

EmitterKind read_spot(Properties& properties, TextureReader& textures, const Diagnostics&) {
    SpotEmitter spot;
    const Matrix to_world = properties.transform("to_world");
    spot.position = transform_point(to_world, Vec3(0.0f));
    spot.axis = z_axis(to_world);
    spot.intensity = textures.constant(properties, "intensity", Rgb(1.0f), ColorUse::radiance);
    const double cutoff = properties.number("cutoff_angle", 20.0);
    const double beam = properties.number("beam_width", cutoff * 0.75);
    if (!(cutoff > 0.0 && cutoff <= 180.0))
        throw InputError(properties.where("cutoff_angle"), "a cutoff angle of " + number_text(cutoff) + " degrees",
                         "give more than 0 and at most 180");
    if (!(beam >= 0.0 && beam <= cutoff))
        throw InputError(properties.where("beam_width"), "a beam width of " + number_text(beam) + " degrees",
                         "give 0 to the cutoff angle");
    spot.cutoff = radians(cutoff);
    spot.beam = std::min(radians(beam), spot.cutoff);
    read_projection(properties, to_world, spot, textures);
    return spot;
}

/// Reads a beam along a line: a spot whose cone has a half angle of a milliradian and the beam's power.
EmitterKind read_collimated(Properties& properties, TextureReader& textures, const Diagnostics&) {
    constexpr double kAngle = 1e-3;
    SpotEmitter spot;
    const Matrix to_world = properties.transform("to_world");
    spot.position = transform_point(to_world, Vec3(0.0f));
    spot.axis = z_axis(to_world);
    const double solid_angle = 4.0 * M_PI * std::pow(std::sin(0.5 * kAngle), 2);
    spot.intensity =
        textures.constant(properties, "power", Rgb(1.0f), ColorUse::radiance) * static_cast<float>(1.0 / solid_angle);
    spot.cutoff = spot.beam = static_cast<float>(kAngle);
    return spot;
}

EmitterKind read_directional(Properties& properties, TextureReader& textures, const Diagnostics&) {
    DirectionalEmitter directional;
    if (properties.has("direction") && properties.has("to_world"))
        throw InputError(properties.where("direction"), "both a direction and a transformation are given", "keep one");
    if (properties.has("direction")) {
        const Vec3 direction = properties.point("direction", directional.direction);
        if (!(direction.length() > 0.0f) || !is_finite(normalize(direction)))
            throw InputError(properties.where("direction"), "the direction has no length", "give another");
        directional.direction = normalize(direction);
    } else {
        directional.direction = z_axis(properties.transform("to_world"));
    }
    directional.irradiance = textures.constant(properties, "irradiance", Rgb(1.0f), ColorUse::radiance);
    return directional;
}

EmitterKind read_constant(Properties& properties, TextureReader& textures, const Diagnostics&) {
    // a constant is equal on all sides
    properties.ignore({"to_world"});
    return ConstantEmitter{textures.constant(properties, "radiance", Rgb(1.0f), ColorUse::radiance)};
}

EmitterKind read_envmap(Properties& properties, TextureReader& textures, const Diagnostics&) {
    EnvironmentEmitter environment = read_environment_axes(properties);
    const double scale = properties.number("scale", 1.0);
    if (!(scale >= 0.0))
        throw InputError(properties.where("scale"), "a scale of " + number_text(scale), "give 0 or more");
    environment.scale = static_cast<float>(scale);
    environment.image = textures.environment_image(properties);
    environment.rows_at_poles = properties.element().version >= 2;
    properties.ignore({"cache"});
    return environment;
}

/// Reads a projector. Mitsuba's irradiance is multiplied by pi. The picture has the orientation that a camera at the
/// same position would see.
EmitterKind read_projector(Properties& properties, TextureReader& textures, const Diagnostics&) {
    const Matrix to_world = properties.transform("to_world");
    if (std::abs(uniform_scale(to_world, 1e-3) - 1.0) > 1e-3)
        throw InputError(properties.where("to_world"), "the projector's transformation contains a scale or shear",
                         "remove it: only rotations, mirrors and translations can move a projector");
    ProjectorEmitter projector;
    projector.position = transform_point(to_world, Vec3(0.0f));
    projector.axis = z_axis(to_world);
    projector.x_axis = normalize(transform_vector(to_world, Vec3(-1.0f, 0.0f, 0.0f)));
    projector.y_axis = normalize(transform_vector(to_world, Vec3(0.0f, -1.0f, 0.0f)));
    projector.irradiance = textures.color(properties, "irradiance", Rgb(1.0f), ColorUse::radiance);
    const double scale = properties.number("scale", 1.0);
    if (!(scale >= 0.0))
        throw InputError(properties.where("scale"), "a scale of " + number_text(scale), "give 0 or more");
    projector.irradiance.value *= static_cast<float>(M_PI * scale);
    const double aspect = textures.aspect(projector.irradiance), half_width = read_half_width(properties, aspect);
    projector.half_width = static_cast<float>(half_width);
    projector.half_height = static_cast<float>(half_width / aspect);
    return projector;
}

struct EmitterReader {
    std::string_view type;
    EmitterKind (*read)(Properties&, TextureReader&, const Diagnostics&);
    int first_version = 0, last_version = 99;  ///< of Mitsuba that have it

    bool is_of(int version) const { return version >= first_version && version <= last_version; }
};

/// Readers of emitters outside shapes. Those of the sky (sky_emitters.h) may add two emitters.
constexpr EmitterReader kReaders[] = {
    {"point", read_point},
    {"spot", read_spot},
    {"directional", read_directional},
    {"constant", read_constant},
    {"envmap", read_envmap},
    {"projector", read_projector, 2},
    {"collimated", read_collimated, 0, 0},
};
constexpr std::string_view kSkies[] = {"sky", "sun", "sunsky"};

/// Cure "use point, spot, ..."; or the type that was probably meant.
std::string cure_of(const std::string& type, int version) {
    std::vector<std::string_view> known;
    for (const EmitterReader& reader : kReaders)
        if (reader.is_of(version)) known.push_back(reader.type);
    known.insert(known.end(), std::begin(kSkies), std::end(kSkies));
    std::string all = "use ";
    for (const std::string_view name : known)
        all += std::string(name) + ", ";
    return did_you_mean(type, known, all + "or area in shapes");
}

}  // namespace

EnvironmentEmitter read_environment_axes(Properties& properties) {
    const Matrix to_world = properties.transform("to_world");
    const double scale = uniform_scale(to_world, 1e-3);
    if (std::abs(scale - 1.0) > 1e-3)
        throw InputError(properties.where("to_world"), "the environment's transformation contains a scale or shear",
                         "remove it: only rotations and mirrors can turn an environment");
    EnvironmentEmitter environment;
    environment.x_axis = normalize(transform_vector(to_world, Vec3(1.0f, 0.0f, 0.0f)));
    environment.y_axis = normalize(transform_vector(to_world, Vec3(0.0f, 1.0f, 0.0f)));
    environment.z_axis = normalize(transform_vector(to_world, Vec3(0.0f, 0.0f, 1.0f)));
    return environment;
}

void read_area_emitter(const XmlElement& emitter, std::int32_t shape, Scene& scene, TextureReader& textures,
                       const SceneDocument& document, Diagnostics& diagnostics) {
    Properties properties(emitter, document, diagnostics);
    if (properties.type() != "area") {
        diagnostics.unsupported(emitter.where, properties.title() + " in a shape is not available in this version",
                                "use <emitter type=\"area\">");
        return;
    }
    if (properties.has("to_world"))
        throw InputError(properties.where("to_world"), "an area emitter has a transformation of its own",
                         "give it to the shape");
    const ColorInput radiance = textures.color(properties, "radiance", Rgb(1.0f), ColorUse::radiance);
    ignore_sampling(properties);
    properties.finish();
    scene.shapes[static_cast<std::size_t>(shape)].emitter = static_cast<std::int32_t>(scene.emitters.size());
    scene.emitters.push_back({AreaEmitter{radiance, shape}, emitter.where});
}

void read_emitter(const XmlElement& emitter, Scene& scene, TextureReader& textures, const SceneDocument& document,
                  Diagnostics& diagnostics) {
    Properties properties(emitter, document, diagnostics);
    const std::string type = properties.type();
    if (type == "area") {
        // Shapes refer to it, and were read before.
        for (const Emitter& known : scene.emitters)
            if (known.where == emitter.where) return;
        diagnostics.unsupported(emitter.where, "the area emitter belongs to no shape",
                                "put it, or a <ref> to its id, into a <shape>");
        return;
    }
    const std::size_t first = scene.emitters.size();
    const bool had_environment = scene.environment() != kNone;
    const auto reader = std::find_if(std::begin(kReaders), std::end(kReaders), [&](const EmitterReader& r) {
        return r.type == type && r.is_of(emitter.version);
    });
    if (reader != std::end(kReaders)) {
        scene.emitters.push_back({reader->read(properties, textures, diagnostics), emitter.where});
    } else if (std::find(std::begin(kSkies), std::end(kSkies), type) != std::end(kSkies)) {
        read_sky(properties, scene, textures);
    } else {
        diagnostics.unsupported(emitter.where, properties.title() + " is not available in this version",
                                cure_of(type, emitter.version));
        return;
    }
    ignore_sampling(properties);
    properties.finish();
    for (std::size_t i = first; i < scene.emitters.size(); ++i)
        if (had_environment && scene.emitters[i].type() == LightType::environment)
            throw InputError(emitter.where, "this is a second environment emitter",
                             "keep one of them; sunsky has a sun in its sky, and a sun with sunRadiusScale 0 is a "
                             "directional light beside any");
}

void add_default_sky(const SceneDocument& document, Scene& scene, TextureReader& textures, Diagnostics& diagnostics) {
    const Location& where = document.root().where;
    const auto element = [&](const char* tag, std::vector<XmlAttribute> attributes) {
        XmlElement made;
        made.tag = tag;
        made.attributes = std::move(attributes);
        made.where = where;
        return made;
    };
    XmlElement sky = element("emitter", {{"type", "sunsky"}}), turn = element("transform", {{"name", "toWorld"}});
    turn.children.push_back(element("rotate", {{"y", "1"}, {"angle", "-120"}}));
    sky.children = {turn, element("float", {{"name", "scale"}, {"value", "2"}}),
                    element("float", {{"name", "sunRadiusScale"}, {"value", "15"}}),
                    element("boolean", {{"name", "extend"}, {"value", "true"}})};
    diagnostics.warn(where, "the scene has no emitters: sun and sky are added, as in Mitsuba 0.6");
    read_emitter(sky, scene, textures, document, diagnostics);
}

}  // namespace treefarm::mitsuba
