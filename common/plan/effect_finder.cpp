// SPDX-License-Identifier: Apache-2.0
#include "common/plan/effect_finder.h"

#include "common/plan/effect_table.h"
#include "common/plan/texture_mean.h"
#include "common/scene/uses/emitter_uses.h"
#include "common/scene/uses/material_uses.h"

namespace treefarm {
namespace {

const char* next_event_name(NextEvent next_event) {
    switch (next_event) {
        case NextEvent::never:
            return "never";
        case NextEvent::always:
            return "always";
        case NextEvent::kickstart:
            return "kickstart";
    }
    return "";
}

}  // namespace

Effect effect_off(const std::string& reason) {
    Effect effect;
    effect.reason = reason;
    return effect;
}

Effect effect_on(const std::string& reason, std::uint64_t bytes) {
    Effect effect;
    effect.on = true;
    effect.reason = reason;
    effect.bytes = bytes;
    return effect;
}

std::string plural(std::size_t count, const std::string& what) {
    if (count == 1) return "1 " + what;
    // "mesh with normals": the word that counts is the first.
    const std::size_t end = what.find(" with ");
    std::string word = what.substr(0, end);
    word += word.ends_with("sh") ? "es" : "s";
    return std::to_string(count) + " " + word + (end == std::string::npos ? "" : what.substr(end));
}

EffectFinder::EffectFinder(const Scene& scene, const Resolved& job)
    : scene_(scene),
      job_(job),
      used_(used_materials(scene)),
      used_directly_(scene.materials.size(), false),
      texture_in_use_(scene.textures.size(), false),
      image_of_textures_(scene.images.size(), false) {
    for (const Shape& shape : scene.shapes)
        if (shape.material != kNone) used_directly_[static_cast<std::size_t>(shape.material)] = true;
    const auto use = [&](std::int32_t texture) { texture_in_use_[static_cast<std::size_t>(texture)] = true; };
    for (std::size_t i = 0; i < scene.materials.size(); ++i)
        if (used_[i]) for_each_texture(scene.materials[i], use);
    for (const Emitter& emitter : scene.emitters)
        for_each_texture(emitter, use);
    for (std::size_t i = 0; i < scene.textures.size(); ++i)
        if (const auto* bitmap = std::get_if<BitmapTexture>(&scene.textures[i].kind); bitmap && texture_in_use_[i])
            image_of_textures_[static_cast<std::size_t>(bitmap->image)] = true;
    add_light();
    add_materials();
    add_textures();
    add_shapes();
    add_transport();
    for (const char* never : {"media", "subsurface", "motion", "polarisation", "dispersion"})
        finders_[never] = [] { return effect_off("not simulated by this program"); };
}

template <class Test>
EffectFinder::Finder EffectFinder::material_finder(const std::string& what, Test test) const {
    return [this, what, test] {
        return called_by(scene_.materials, what,
                         [&](const Material& m, std::size_t i) { return used_[i] && test(own_traits(m)); });
    };
}

template <class Test>
EffectFinder::Finder EffectFinder::texture_finder(const std::string& what, Test test) const {
    return [this, what, test] {
        return called_by(scene_.textures, what,
                         [&](const Texture& t, std::size_t i) { return texture_in_use_[i] && test(t); });
    };
}

std::uint64_t EffectFinder::emitter_bytes(const std::function<bool(const Emitter&)>& test) const {
    std::uint64_t bytes = 0;
    for (const Emitter& emitter : scene_.emitters) {
        if (!test(emitter)) continue;
        bytes += kEmitterBytes + emitter_table_bytes(scene_, emitter);
        for_each_image(
            emitter, [&](std::int32_t image) { bytes += image_bytes(scene_.images[static_cast<std::size_t>(image)]); });
    }
    return bytes;
}

void EffectFinder::add_light() {
    const auto sampled = [this] {
        if (job_.integrator.next_event == NextEvent::never) return effect_off("integrator.next_event = \"never\"");
        if (scene_.emitters.empty()) return effect_off("there are no emitters");
        return effect_on(std::string("integrator.next_event = \"") + next_event_name(job_.integrator.next_event) +
                         "\", " + plural(scene_.emitters.size(), "emitter"));
    };
    finders_["next_event"] = sampled;
    finders_["mis"] = [this, sampled] {
        if (!sampled().on) return effect_off("there is no next event to weigh");
        const MisHeuristic mis = job_.integrator.mis;
        return effect_on(mis == MisHeuristic::power     ? "integrator.mis = \"power\""
                         : mis == MisHeuristic::balance ? "integrator.mis = \"balance\""
                                                        : "integrator.mis = \"equal\"");
    };
    finders_["kickstart"] = [this] {
        if (job_.integrator.next_event == NextEvent::kickstart)
            return effect_on("integrator.next_event = \"kickstart\"");
        return effect_off(std::string("integrator.next_event = \"") + next_event_name(job_.integrator.next_event) +
                          "\"");
    };
    for_each_emitter_kind([this]<class Kind>() {
        finders_[Kind::kTraits.effect] = [this] {
            const auto is = [](const Emitter& emitter) { return std::holds_alternative<Kind>(emitter.kind); };
            Effect effect = called_by(scene_.emitters, Kind::kTraits.title,
                                      [&](const Emitter& emitter, std::size_t) { return is(emitter); });
            // delta_lights counts those of its kinds.
            if (Kind::kTraits.type != LightType::delta) effect.bytes = emitter_bytes(is);
            return effect;
        };
    });
    finders_["textured_area"] = [this] {
        return called_by(scene_.emitters, "textured area emitter", [](const Emitter& emitter, std::size_t) {
            return emitter.type() == LightType::area && is_textured(emitter);
        });
    };
    finders_["delta_lights"] = [this] {
        const auto is = [](const Emitter& emitter) { return emitter.type() == LightType::delta; };
        Effect effect = called_by(scene_.emitters, delta_light_names() + " emitter",
                                  [&](const Emitter& emitter, std::size_t) { return is(emitter); });
        effect.bytes = emitter_bytes(is);
        return effect;
    };
    finders_["environment"] = [this] {
        return called_by(scene_.emitters, "emitter around the scene",
                         [](const Emitter& emitter, std::size_t) { return emitter.type() == LightType::environment; });
    };
}

void EffectFinder::add_materials() {
    using Traits = MaterialTraits;
    const auto add = [this](const char* name, const char* what, auto test) {
        finders_[name] = material_finder(what, test);
    };
    add("diffuse", "material with a diffuse lobe", [](const Traits& t) { return t.lobes.diffuse; });
    add("delta_reflection", "smooth material", [](const Traits& t) { return t.lobes.delta_reflection; });
    add("microfacets", "rough material", [](const Traits& t) { return t.microfacets; });
    add("anisotropy", "anisotropic material", [](const Traits& t) { return t.anisotropic; });
    add("transmission", "dielectric",
        [](const Traits& t) { return t.lobes.glossy_transmission || t.lobes.delta_transmission; });
    add("coats", "plastic", [](const Traits& t) { return t.coated; });
    const auto add_kind = [this]<class Kind>(const char* name, const char* what, std::in_place_type_t<Kind>) {
        finders_[name] = [this, what] {
            return called_by(scene_.materials, what, [&](const Material& m, std::size_t i) {
                return used_[i] && std::holds_alternative<Kind>(m.bsdf);
            });
        };
    };
    add_kind("rough_diffuse", "rough diffuse material", std::in_place_type<RoughDiffuseMaterial>);
    add_kind("phong", "Phong material", std::in_place_type<PhongMaterial>);
    add_kind("principled", "principled material", std::in_place_type<PrincipledMaterial>);
    add_kind("principled_thin", "thin principled material", std::in_place_type<PrincipledThinMaterial>);
    add_kind("coatings", "coated material", std::in_place_type<CoatingMaterial>);
    add_kind("ward", "Ward material", std::in_place_type<WardMaterial>);
    add("blends", "blend", [](const Traits& t) { return t.blended; });
    add("null", "null material", [](const Traits& t) { return t.lobes.null; });
    add("twosided", "twosided material", [](const Traits& t) { return t.twosided; });
    add("bump", "bumpy material", [](const Traits& t) { return t.bumped; });
    add("normal_maps", "material with a normal map", [](const Traits& t) { return t.normal_mapped; });
}

void EffectFinder::add_textures() {
    finders_["textures"] = [this] {
        Effect effect = material_finder("textured material", [](const MaterialTraits& t) { return t.textured; })();
        for (const Shape& shape : scene_.shapes)
            if (const auto* mesh = std::get_if<Mesh>(&shape.geometry)) effect.bytes += mesh->uvs.size() * sizeof(Vec2);
        return effect;
    };
    finders_["bitmaps"] = [this] {
        Effect effect =
            texture_finder("bitmap", [](const Texture& t) { return std::holds_alternative<BitmapTexture>(t.kind); })();
        for (std::size_t i = 0; i < scene_.images.size(); ++i)
            if (image_of_textures_[i]) effect.bytes += image_bytes(scene_.images[i]);
        return effect;
    };
    finders_["checkerboards"] = texture_finder(
        "checkerboard", [](const Texture& t) { return std::holds_alternative<CheckerboardTexture>(t.kind); });
}

}  // namespace treefarm
