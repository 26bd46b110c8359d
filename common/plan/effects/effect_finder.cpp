// SPDX-License-Identifier: Apache-2.0
#include "common/plan/effects/effect_finder.h"

#include "common/plan/effects/effect_table.h"
#include "common/scene/uses/emitter_uses.h"
#include "common/scene/uses/material_uses.h"
#include "common/scene/uses/texture_mean.h"
#include "common/scene/uses/texture_uses.h"

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
        case NextEvent::automatic:
            return "auto";
        case NextEvent::while_it_pays:
            return "while_it_pays";
    }
    return "";
}

/// Whether an effect is switched off together with another one.
constexpr bool is_part(std::string_view part, std::string_view whole) {
    return find_effect([&](const auto& row) {
               if constexpr (requires { row.off.whole; }) return part == row.text.name && whole == row.off.whole;
               return false;
           }) < kEffectCount;
}

/// The effect that a kind declares as its own, or an empty name.
template <class Kind>
constexpr std::string_view own_effect() {
    if constexpr (requires { Kind::kTraits; })
        return Kind::kTraits.effect;
    else if constexpr (requires { Kind::kEffect; })
        return Kind::kEffect.name;
    else
        return {};
}

/// Whether the effects that kinds declare are rows of their family, and every such row belongs to a kind.
template <class Variant>
constexpr bool kinds_have_rows(EffectFamily family) {
    bool all = true;
    for_each_kind<Variant>([&]<class Kind>() {
        if (!own_effect<Kind>().empty() && !is_effect_of(family, own_effect<Kind>())) all = false;
    });
    return all;
}
template <class Variant>
constexpr bool rows_have_kinds(EffectFamily family) {
    bool all = true;
    for_each_effect([&](const auto& row) {
        bool found = row.family != family;
        for_each_kind<Variant>([&]<class Kind>() { found = found || own_effect<Kind>() == row.text.name; });
        all = all && found;
    });
    return all;
}
static_assert(kinds_have_rows<EmitterKind>(EffectFamily::emitters) &&
              rows_have_kinds<EmitterKind>(EffectFamily::emitters));
static_assert(kinds_have_rows<MaterialKind>(EffectFamily::materials) &&
              rows_have_kinds<MaterialKind>(EffectFamily::materials));
static_assert(kinds_have_rows<TextureKind>(EffectFamily::textures) &&
              rows_have_kinds<TextureKind>(EffectFamily::textures));

/// Whether delta lights are switched off together, and environments, too.
constexpr bool emitters_go_off_with_their_type() {
    bool all = true;
    for_each_kind<EmitterKind>([&]<class Kind>() {
        constexpr LightType kType = Kind::kTraits.type;
        if (kType == LightType::delta) all = all && is_part(Kind::kTraits.effect, "delta_lights");
        if (kType == LightType::environment) all = all && is_part(Kind::kTraits.effect, "environment");
    });
    return all;
}
static_assert(emitters_go_off_with_their_type());

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
    // In "mesh with normals" the first word is the noun.
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
      texture_in_use_(scene.textures.size(), false) {
    for (const Shape& shape : scene.shapes)
        if (shape.material != kNone) used_directly_[static_cast<std::size_t>(shape.material)] = true;
    const auto use = [&](std::int32_t texture) { texture_in_use_[static_cast<std::size_t>(texture)] = true; };
    for (std::size_t i = 0; i < scene.materials.size(); ++i)
        if (used_[i]) for_each_texture(scene.materials[i], use);
    for (const Emitter& emitter : scene.emitters)
        for_each_texture(emitter, use);
}

Effect EffectFinder::find(EffectId effect) const {
    Effect found;
    std::size_t index = 0;
    for_each_effect([&](const auto& row) {
        if (index++ == effect.index()) found = find(row);
    });
    return found;
}

Effect EffectFinder::kind(EffectFamily family, std::string_view effect) const {
    Effect found;
    for_each_emitter_kind([&]<class Kind>() {
        if (family == EffectFamily::emitters && effect == Kind::kTraits.effect) found = emitter_kind<Kind>();
    });
    for_each_kind<TextureKind>([&]<class Kind>() {
        if (family == EffectFamily::textures && effect == Kind::kEffect.name) found = texture_kind<Kind>();
    });
    for_each_kind<MaterialKind>([&]<class Kind>() {
        if constexpr (requires { Kind::kEffect; })
            if (family == EffectFamily::materials && effect == Kind::kEffect.name)
                found = called_by(scene_.materials, Kind::kEffect.title, [&](const Material& m, std::size_t i) {
                    return used_[i] && std::holds_alternative<Kind>(m.bsdf);
                });
    });
    return found;
}

template <class Kind>
Effect EffectFinder::emitter_kind() const {
    const auto is = [](const Emitter& emitter) { return std::holds_alternative<Kind>(emitter.kind); };
    Effect effect = called_by(scene_.emitters, Kind::kTraits.title,
                              [&](const Emitter& emitter, std::size_t) { return is(emitter); });
    // the effect delta_lights counts the bytes of its kinds
    if (Kind::kTraits.type != LightType::delta) effect.bytes = emitter_bytes(is);
    return effect;
}

template <class Kind>
Effect EffectFinder::texture_kind() const {
    const auto is = [&](std::size_t i) {
        return texture_in_use_[i] && std::holds_alternative<Kind>(scene_.textures[i].kind);
    };
    Effect effect =
        called_by(scene_.textures, Kind::kEffect.title, [&](const Texture&, std::size_t i) { return is(i); });
    std::vector<bool> counted(scene_.images.size(), false);
    for (std::size_t i = 0; i < scene_.textures.size(); ++i)
        if (is(i))
            for_each_image(scene_.textures[i], [&](std::int32_t image) {
                const auto at = static_cast<std::size_t>(image);
                if (!counted[at]) effect.bytes += image_bytes(scene_.images[at]);
                counted[at] = true;
            });
    return effect;
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

Effect EffectFinder::next_event() const {
    if (job_.integrator.next_event == NextEvent::never) return effect_off("integrator.next_event = \"never\"");
    if (scene_.emitters.empty()) return effect_off("there are no emitters");
    return effect_on(std::string("integrator.next_event = \"") + next_event_name(job_.integrator.next_event) + "\", " +
                     (job_.decides_next_event ? "at every vertex at first, then as passes show, " : "") +
                     plural(scene_.emitters.size(), "emitter"));
}

Effect EffectFinder::mis() const {
    if (!next_event().on) return effect_off("there is no next event to weigh");
    const MisHeuristic mis = job_.integrator.mis;
    return effect_on(mis == MisHeuristic::power     ? "integrator.mis = \"power\""
                     : mis == MisHeuristic::balance ? "integrator.mis = \"balance\""
                                                    : "integrator.mis = \"equal\"");
}

Effect EffectFinder::kickstart() const {
    if (job_.integrator.next_event == NextEvent::kickstart) return effect_on("integrator.next_event = \"kickstart\"");
    return effect_off(std::string("integrator.next_event = \"") + next_event_name(job_.integrator.next_event) + "\"");
}

Effect EffectFinder::textured_area() const {
    return called_by(scene_.emitters, "textured area emitter", [](const Emitter& emitter, std::size_t) {
        return emitter.type() == LightType::area && is_textured(emitter);
    });
}

Effect EffectFinder::delta_lights() const {
    const auto is = [](const Emitter& emitter) { return emitter.type() == LightType::delta; };
    Effect effect = called_by(scene_.emitters, names_of_parts("delta_lights") + " emitter",
                              [&](const Emitter& emitter, std::size_t) { return is(emitter); });
    effect.bytes = emitter_bytes(is);
    return effect;
}

Effect EffectFinder::environment() const {
    return called_by(scene_.emitters, "emitter around the scene",
                     [](const Emitter& emitter, std::size_t) { return emitter.type() == LightType::environment; });
}

Effect EffectFinder::textures() const {
    Effect effect = materials("textured material", [](const MaterialTraits& t) { return t.textured; });
    for (const Shape& shape : scene_.shapes)
        if (const auto* mesh = std::get_if<Mesh>(&shape.geometry)) effect.bytes += mesh->uvs.size() * sizeof(Vec2);
    return effect;
}

}  // namespace treefarm
